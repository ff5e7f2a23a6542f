import json,glob,sys
P={'base_load','brake_power','copper_loss','iron_loss','inverter_loss','no_regeneration'}
right=[];wrong=[]
for root in sys.argv[1:]:
    lab={i['case']:json.loads(i['label']) for i in json.load(open(root+'/labels.key'))['labels']}
    for c,t in sorted(lab.items()):
        try: j=json.load(open(f'{root}/{c}/diagnosis.json'))
        except Exception: continue
        if t['kind'] in('motion','power'): continue
        true={e['id'] for e in t['effects']}|{q for e in t['effects'] for q in e['equivalents']}
        for e in j['effects']:
            ok=e['id'] in true or bool(true&set(e.get('class',[])))
            (right if ok else wrong).append((round(e['nats']),round(e.get('share_percent') or 0,2),round(e.get('size_percent') or 0,2),e['id'],root[-1]+c[-3:],t['kind'],t['trust'], round(j['gap'][0]['shrink_percent']['value'],1) if j.get('gap') else None))
right.sort();wrong.sort()
print('WRONG',len(wrong)); [print(' ',w) for w in wrong]
print('RIGHT',len(right)); [print(' ',w) for w in right[:45]]
