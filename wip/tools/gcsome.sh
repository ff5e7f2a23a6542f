BIN=$1; OUT=$2; : > $OUT
for n in ${@:3}; do c=case0$n; cd /tmp/gc/$c; a=$(sed 's/^diagnose //; s/--out OUT.toml//; s/--format json//' command.txt); s=$(date +%s.%N); $BIN diagnose $a --quiet --format json > /tmp/gc_$n.json 2>/tmp/gc_$n.err; e=$(date +%s.%N); python3 - $n $s $e >> $OUT <<'P'
import json,sys
n,s,e=sys.argv[1:]
k=[c for c in json.load(open('/work/shared/data/gap_cases/key.json'))['cases'] if c['case'].endswith(n)][0]
try: r=json.load(open(f'/tmp/gc_{n}.json'))
except Exception as x: print(n,'ERR',x); sys.exit()
print(n,k['kind'],[(x['id'],x['joints']) for x in k.get('effects',[])],'->',r['verdict'],[(x['id'],x['joints']) for x in r['effects']],'| c',[(x['id'],x['joints'],round(x['nats'])) for x in r['candidates']],'| f',[(x['hypothesis'][:28],x['gate'],round(x['value'],3),round(x['limit'],3)) for x in r['trail'] if not x['passed']][:3],'%.1f s'%(float(e)-float(s)))
P
done; echo finished >> $OUT
