import json,glob,sys,collections
tot=rw=0; by=collections.defaultdict(lambda: [0.0,0]); per=collections.defaultdict(list)
e0=e1=a0=a1=0
for f in sorted(glob.glob(sys.argv[1]+'/*.json')):
    try: r=json.load(open(f))
    except Exception as e: print(f,e); continue
    e0+=r['original']['motion_energy_j']; e1+=r['optimized']['motion_energy_j']; a0+=r['original']['energy_j']; a1+=r['optimized']['energy_j']
    for s in r['segments']:
        if s['kind']=='idle': continue
        t=s['time_before_s']; tot+=t
        share=s['rewritten_executions']/max(1,s['executions'])
        rw+=t*share
        if share<1:
            why=(s['reason'] or 'none')
            code=why.split(':')[0]
            by[code][0]+=t*(1-share); by[code][1]+=1
            per[code].append((t*(1-share),f.split('/')[-1][:-5],s['line_first'],why[:150]))
print(f'{rw:.1f} of {tot:.1f} s = {100*rw/tot:.1f} %; motion {100*(1-e1/e0):.2f} %, all {100*(1-a1/a0):.2f} %')
for k,v in sorted(by.items(),key=lambda x:-x[1][0]): print(f'{k:18s} {v[0]:7.1f} s {v[1]}')
for k in sys.argv[2:]:
    print(k)
    for x in sorted(per[k],reverse=True)[:25]: print('  %.1f %s:%d %s'%x)
