import json,glob,os
d=json.load(open('case.json'))
a=['--robot',d.get('robot','nominal.toml')]
for f in sorted(glob.glob('log*.csv')): a+=['--log',f]
h=sorted(glob.glob('heldout*.csv'))
for f in h: a+=['--heldout',f]
for f in sorted(glob.glob('baseline*.csv')): a+=['--baseline',f]
a+=['--trust',d['trust']]
if d.get('period'): a+=['--period',str(d['period'])]
if d.get('program'): a+=['--program',d['program']]
print(' '.join(a))
