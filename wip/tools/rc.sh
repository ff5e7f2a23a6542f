#!/bin/bash
# rc.sh BIN W CASE -> verdict line
cd /tmp/cal/$2/case-00$3; r=$(python3 -c "import json;print(json.load(open('case.json')).get('robot','nominal.toml'))"); t=$(python3 -c "import json;d=json.load(open('case.json'));print('--trust '+d['trust']+(' --period %s'%d['period'] if d.get('period') else ''))"); b=$(ls baseline*.csv 2>/dev/null); [ -n "$b" ] && b="--baseline $b"
s=$(date +%s.%N); $1 diagnose --robot $r --log $(ls log*.csv) --heldout $(ls heldout*.csv) $b $t --quiet --format json > /tmp/rc_$2_$3.json; e=$(date +%s.%N)
python3 - $2 $3 $s $e <<'P'
import json,sys
w,c,s,e=sys.argv[1:]
r=json.load(open(f'/tmp/rc_{w}_{c}.json'))
d=json.load(open(f'/tmp/cal/{w}/labels.key'))
t=[json.loads(i['label']) for i in d['labels'] if i['case']=='case-00'+c][0]
print(w,c,t['kind'],[(x['id'],x['joints'],round(x['nats'])) for x in t['effects']],'->',r['verdict'],[(x['id'],x['joints']) for x in r['effects']],'| cand',[(x['id'],x['joints'],round(x['nats'])) for x in r['candidates']],'| failed',[(x['hypothesis'][:28],x['gate'],round(x['value'],3),round(x['limit'],3)) for x in r['trail'] if not x['passed']][:5],'%.1f s'%(float(e)-float(s)))
P
