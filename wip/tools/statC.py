import json,glob,collections,sys
for w in ['C']:
    lab={i['case']:json.loads(i['label']) for i in json.load(open(f'/tmp/ex/{w}/labels.key'))['labels']}
    for d in sorted(glob.glob(f'/tmp/ex/{w}/case-*/')):
        c=d.split('/')[-2]
        try: j=json.load(open(d+'diagnosis.json'))
        except Exception as e: continue
        t=lab[c]
        f=[(x['hypothesis'][:28],x['gate'],round(x['value'],3),round(x['limit'],3)) for x in j['trail'] if not x['passed']][:4]
        S=lambda l:[(e['id'],''.join(map(str,e.get('joints') or [])),e.get('share_percent') and round(e['share_percent'],2) or round(e.get('size_percent',0),2),round(e.get('nats',0))) for e in l]
        print(w,c[-2:],t['kind'],[(e['id'],''.join(map(str,e['joints'])),round(e['nats']) ) for e in t['effects']],'->',j['verdict'],S(j['effects']),'| c',S(j['candidates']),'| f',f)
