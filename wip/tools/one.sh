# one.sh BIN W NN
cd /tmp/cal/$2/case-00$3; RAYON_NUM_THREADS=1 nice -n 19 timeout 400 $1 diagnose $(cat d.args) --quiet --format json > /tmp/o_$2_$3.json 2>/tmp/o_$2_$3.err
python3 - $2 $3 <<'P'
import json,sys
w,c=sys.argv[1:]
lab={i['case']:json.loads(i['label']) for i in json.load(open(f'/tmp/cal/{w}/labels.key'))['labels']}
t=lab[f'case-00{c}']; j=json.load(open(f'/tmp/o_{w}_{c}.json'))
f=[(x['hypothesis'][:28],x['gate'],round(x['value'],3),round(x['limit'],3)) for x in j['trail'] if not x['passed']][:4]
S=lambda l:[(e['id'],''.join(map(str,e.get('joints') or [])),round(e.get('size_percent') or 0,2),round(e.get('nats',0))) for e in l]
print(w,c,t['kind'],[(e['id'],''.join(map(str,e['joints'])),round(e['nats']) ) for e in t['effects']],'->',j['verdict'],S(j['effects']),'| c',S(j['candidates']),'| f',f)
P
