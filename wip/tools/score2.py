import json,sys,os
KEY={c['case']:c for c in json.load(open('/work/shared/data/gap_cases/key.json'))['cases']}
def truth(case):
    p=case+'/truth.json'
    if os.path.exists(p):
        t=json.load(open(p)); 
        for e in t['effects']: e.setdefault('nats',99); e.setdefault('equivalents',[])
        return t['kind'],t['effects'],t
    k=KEY[os.path.basename(case)]
    kind={'none':'healthy','single':'one','pair':'two','ool':'outside'}.get(k['kind'],k['kind'])
    return kind,[dict(id=e['id'],joints=e['joints'],equivalents=[c for c in (e.get('class') or []) if c!=e['id']],nats=e.get('llr') or 0,form='') for e in k.get('effects',[])],k
CL=[{'load_friction','gear_efficiency'},{'time_delay','filter_lag'}]
def eq(a,e): return a==e['id'] or a in e['equivalents'] or any(a in c and e['id'] in c for c in CL)
tab={};v='-v' in sys.argv; times=[]; tot={}
for f in [a for a in sys.argv[1:] if a[0]!='-']:
    for line in open(f):
        try: d=json.loads(line)
        except Exception: continue
        kind,eff,t=truth(d['case'])
        if kind in('motion','power'): continue
        eff=[e for e in eff if e['id']!='outside']
        param=[e for e in eff if e['id']=='link_parameters']
        if param and len(eff)==1: kind='healthy'
        times.append(d['t'])
        named=[(e['id'],e['class']) for e in d['effects']]
        ok=lambda e: any(eq(i,e) or any(eq(c,e) for c in cl) for i,cl in named)
        wrong=[i for i,cl in named if not any(eq(i,e) or any(eq(c,e) for c in cl) for e in eff)]
        det=[e for e in eff if e['nats']>=10 and not e.get('undetectable')]
        if kind in('healthy','parameters_only'):
            res='NAMED' if named else ('ok' if d['verdict'] in('no_gap','parameters_only') else d['verdict'])
        elif kind=='outside': res='NAMED' if named else ('ok' if d['verdict'] in ('unknown','partial') else 'miss')
        elif kind=='one':
            res='WRONG' if wrong else ('right' if any(map(ok,eff)) else ('undet' if not det else 'abst:'+d['verdict']))
        else:
            k=sum(map(ok,eff)); res='WRONG' if wrong else ['abst','one','both'][min(k,2)]
        tab.setdefault((os.path.basename(f),kind),{}).setdefault(res,[]).append(d['case'])
        if v: print(os.path.basename(d['case']),kind,res,[(e['id'],e.get('form',''),e['joints'],round(e['nats'])) for e in eff],t.get('outside',t.get('fault','')) if kind=='outside' else '','->',d['verdict'],[(e['id'],e['joints'],e['size'],round(e['nats'])) + ((e['class'],) if len(e['class'])>1 else ()) for e in d['effects']],'cand',[(e['id'],e['joints'],e['size']) for e in d['candidates']],'ev',d['everyday'],'rem',d['remainder'],'failed',[x for x in d['failed'] if 'Unexpl' not in x][:4],'shr',round(d['shrink'][0],2),'t',round(d['t'],1))
for k in sorted(tab): print(k,{a:len(b) for a,b in sorted(tab[k].items())})
times.sort()
if times: print('time median',round(times[len(times)//2],1),'max',round(times[-1],1))
