import json,sys
num=den=0;orc=[]
key={c['case']:c for c in json.load(open('/work/shared/data/gap_cases/key.json'))['cases']}
for f in sys.argv[1:]:
    for l in open(f):
        try:d=json.loads(l)
        except: continue
        k=key.get(d['case'][-7:]);
        if not k or 'heldout' not in k: continue
        h=k['heldout']
        rel=lambda v:sum((a/b)**2 for a,b in zip(v,h['torque_rms']))
        m=rel(h['model']); o=1-(rel(h['oracle'])/m)**.5
        g=[x[4] for x in d['gap']]; ref=[x[3] for x in d['gap']]
        mine=1-(rel(g)/m)**.5; r=1-(rel(ref)/m)**.5
        orc.append(mine/o); print(d['case'][-7:],k['kind'],round(mine,2),'refit',round(r,2),'oracle',round(o,2))
print(sum(orc)/len(orc), sorted(orc)[len(orc)//2])
