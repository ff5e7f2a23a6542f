import json,sys
d=json.load(open(sys.argv[1]))
tot=0;tb=0
for s in d['segments']:
    if s['kind']!='timing': continue
    b,a,l=s['energy_before_j'],s['energy_after_j'],s.get('lower_bound_j')
    print(s['file'].split('/')[-1],s['line_first'],s['reason'] and s['reason'][:30],s['executions'],s['rewritten_executions'],'saved %.1f bound %s pts %s'%(b-a,l and round(b-l,1),s.get('points')))
    if l: tot+=b-a; tb+=b-l
print('total %.1f of %.1f = %.3f'%(tot,tb,tot/tb), 'motion saving %', d['motion_saving_percent'])
