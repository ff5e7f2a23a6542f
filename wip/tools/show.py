import json,sys
for l in open(sys.argv[1]):
    try:d=json.loads(l)
    except: continue
    print(d['case'][-12:],d['gates'],[round(max(x,0),4) for x in d['everyday']])
