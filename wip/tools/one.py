import json,sys;d=json.load(open(sys.argv[1]));print(d['verdict'],[ (e['id'],e['joints'],e['size'],e['nats']) for e in d['effects']],'cand',[ (e['id'],e['joints'],e['size'],e['nats']) for e in d['candidates']]);print(d['failed'])
for g in d['gap']:print(g)
print(d['everyday'],d['remainder'],d['laps'])
