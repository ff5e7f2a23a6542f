#!/usr/bin/env python3
"""reach_measure.py run [names] | table"""
import json,os,subprocess,sys,time,collections
B='/tmp/jp_now'; R='/work/wt/reach'; C='fixtures/cells'; O='/work/wt/reach_out'
os.makedirs(O,exist_ok=True)
runs=json.load(open('/work/wt/reach_runs.json'))
progs=sorted(p for p in os.listdir(f'{R}/{C}') if p!='README.md')
env=dict(os.environ,RAYON_NUM_THREADS='1')
def go(p):
    t=time.time(); err=open(f'{O}/{p}.err','w')
    try:
        r=subprocess.run(['nice','-n','10',B,'optimize',f'{C}/{p}','--point-estimate','--format','json']+runs.get(p,[]),cwd=R,env=env,stdout=open(f'{O}/{p}.json','w'),stderr=err,timeout=120); rc=r.returncode
    except subprocess.TimeoutExpired: rc='timeout'
    json.dump({'rc':rc,'s':time.time()-t},open(f'{O}/{p}.meta','w')); print(p,rc,round(time.time()-t,1),flush=True)
def table():
    T=RW=EB=EA=AB=AA=0; S=0; reas=collections.defaultdict(lambda:[0,0,[]]); rows=[]; unres=collections.Counter(); unex={}
    for p in progs:
        if not os.path.exists(f'{O}/{p}.meta'): continue
        m=json.load(open(f'{O}/{p}.meta'))
        if m['rc']!=0: rows.append((p,None,m)); continue
        d=json.load(open(f'{O}/{p}.json'))
        t=rw=0
        for s in d['segments']:
            if s['kind']!='timing': continue
            b=s['time_before_s']; t+=b
            if s['rewritten']:
                # a place that is rewritten only in some of its executions has its other time as a reason
                part=b*s['rewritten_executions']/max(1,s['executions']); rw+=part
                rest=b-part
                if rest>1e-9:
                    k='(executions not rewritten) '+str(s['reason']).split(':')[0]; reas[k][0]+=rest; reas[k][1]+=1; reas[k][2].append((rest,p,s['line_first'],str(s['reason'])))
            else:
                k=str(s['reason']).split(':')[0]; reas[k][0]+=b; reas[k][1]+=1; reas[k][2].append((b,p,s['line_first'],str(s['reason'])))
        T+=t; RW+=rw; o,n=d['original'],d['optimized']
        EB+=o['motion_energy_j'];EA+=n['motion_energy_j'];AB+=o['energy_j'];AA+=n['energy_j']; S+=m['s']
        un=[u for u in d['unresolved']]
        rows.append((p,t,rw,d['motion_saving_percent'],d['saving_percent'],o['cycle_s'],m['s'],d['verification']['passed'] if d['verification'] else None))
    print(f"{'program':28} {'cycle':>6} {'move s':>7} {'rewr s':>7} {'share':>6} {'motion%':>8} {'all%':>6} {'cpu s':>6}")
    for r in rows:
        if r[1] is None: print(f'{r[0]:28} FAILED {r[2]}'); continue
        p,t,rw,ms,ss,c,cpu,v=r
        print(f'{p:28} {c:6.1f} {t:7.2f} {rw:7.2f} {100*rw/t if t else 0:5.0f}% {ms or 0:8.2f} {ss or 0:6.2f} {cpu:6.1f} {"" if v else "verification "+str(v)}')
    ok=[r for r in rows if r[1]]
    print(f'total {len(ok)}: move {T:.1f} s, rewritten {RW:.1f} s = {100*RW/T:.1f} %, mean share {100*sum(r[2]/r[1] for r in ok)/len(ok):.1f} %; motion energy {EB:.0f} -> {EA:.0f} J = {100*(1-EA/EB):.2f} %, all {AB:.0f} -> {AA:.0f} = {100*(1-AA/AB):.2f} %; cpu {S:.0f} s')
    fam=collections.defaultdict(lambda:[0,0])
    F=lambda p:{'pal':'palletising','ten':'machine tending','wel':'welding','glu':'dispensing','pai':'dispensing','scr':'assembly','asm':'assembly'}.get(p[:3],'drawing/finishing/inspection')
    for r in ok: fam[F(r[0])][0]+=r[1]; fam[F(r[0])][1]+=r[2]
    for k,(a,b) in fam.items(): print(f'  {k:30} {a:7.1f} s {100*b/a:5.1f} %')
    for k,(b,n,l) in sorted(reas.items(),key=lambda x:-x[1][0]):
        print(f'{k:42} {b:7.1f} s {100*b/T:5.1f} % {n:4} places')
        if '-l' in sys.argv:
            g=collections.defaultdict(lambda:[0,0,set()])
            for e in l: x=g[e[3]]; x[0]+=e[0]; x[1]+=1; x[2].add((e[1],e[2]))
            for t,(b2,n2,s2) in sorted(g.items(),key=lambda x:-x[1][0])[:12]: print(f'      {b2:6.1f} s {n2:3}  {t[:230]}  e.g. {sorted(s2)[:3]}')
if sys.argv[1]=='run':
    for p in progs:
        if len(sys.argv)<3 or any(a in p for a in sys.argv[2:]): go(p)
else: table()
