import json,sys
right=[];wrong=[]
for root in sys.argv[1:]:
    lab={i['case']:json.loads(i['label']) for i in json.load(open(root+'/labels.key'))['labels']}
    for c,t in sorted(lab.items()):
        try: j=json.load(open(f'{root}/{c}/diagnosis.json'))
        except Exception: continue
        if t['kind'] in('motion','power') or not j['effects'] : continue
        true={e['id'] for e in t['effects']}|{q for e in t['effects'] for q in e['equivalents']}
        ok=[e['id'] in true or bool(true&set(e.get('class',[]))) for e in j['effects']]
        g=j['gap'][0].get('shrink_by_effect_percent')
        ho=[(round(x['value'],3)) for x in j['trail'] if x['gate']=='held_out' and x['passed']]
        row=(min(round(e['nats']) for e in j['effects']),[round(g[k],1) for k in('value','low','high')] if g else None,ho,[e['id'] for e in j['effects']],root[-3:]+c[-3:],t['kind'],t['trust'],j['gap'][0].get('heldout'))
        (right if all(ok) else wrong).append(row)
key=lambda r:(r[1] or [0,0,0])[1]
right.sort(key=key);wrong.sort(key=key)
print('WRONG'); [print(' ',w) for w in wrong]
print('RIGHT'); [print(' ',w) for w in right]
