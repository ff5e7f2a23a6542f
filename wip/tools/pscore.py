import json,glob,sys,subprocess,os
from concurrent.futures import ThreadPoolExecutor
P={'base_load','brake_power','copper_loss','iron_loss','inverter_loss','no_regeneration'}
B=sys.argv[1]; dirs=sys.argv[2:]
def argv(d):
    return subprocess.run(['python3','/tmp/argv.py'],cwd=d,capture_output=True,text=True).stdout.split()
jobs=[]
for w in dirs:
    lab={i['case']:json.loads(i['label']) for i in json.load(open(w+'/labels.key'))['labels']}
    for c,t in sorted(lab.items()):
        if any(e['id'] in P for e in t['effects']): jobs.append((w,c,t))
def run(j):
    w,c,t=j; d=f'{w}/{c}'
    r=subprocess.run([B,'diagnose',*argv(d),'--effects',','.join(sorted(P)),'--quiet','--format','json'],cwd=d,capture_output=True,text=True,env={**os.environ,'RAYON_NUM_THREADS':'1'})
    try: return json.loads(r.stdout)
    except Exception: return {'verdict':'ERR','effects':[],'candidates':[],'err':r.stderr[:200]}
right=wrong=0; per={}
with ThreadPoolExecutor(2) as ex:
    for j,r in zip(jobs,ex.map(run,jobs)):
        w,c,t=j
        true=[e for e in t['effects'] if e['id'] in P]
        said=[e for e in r['effects'] if e['id'] in P]
        ok=all(any(x['id']==e['id'] or e['id'] in x.get('class',[]) for x in said) for e in true) 
        bad=[x['id'] for x in said if not any(x['id']==e['id'] or e['id'] in x.get('class',[]) for e in t['effects'])]
        right+=ok; wrong+=bool(bad)
        k=w.split('/')[-1][0]; p=per.setdefault(k,[0,0,0]); p[0]+=ok;p[1]+=bool(bad);p[2]+=1
        print(w.split('/')[-1],c,[(e['id'],e['joints']) for e in t['effects']],'->',r['verdict'],[(x['id'],x['joints'],round(x.get('nats',0)),x.get('class')) for x in said],r.get('err',''),'OK' if ok else '', 'WRONG' if bad else '',flush=True)
print(B,len(jobs),'right',right,'wrong',wrong,per)
