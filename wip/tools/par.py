import json,glob
for w in ['a','b','own']:
    lab={i['case']:json.loads(i['label']) for i in json.load(open(f'/tmp/cal/{w}/labels.key'))['labels']}
    for d in sorted(glob.glob(f'/tmp/cal/{w}/case-*/')):
        c=d.split('/')[-2]
        try: j=json.load(open(d+'diagnosis.json'))
        except Exception as e: continue
        t=lab[c]
        for e in t['effects']:
            f=[x for x in j['effects'] if x['id']==e['id']]
            if not f: continue
            f=f[0]
            for p in e['parameters']:
                if not p.get('graded'): continue
                n=p['name']; 
                js=[k for k in f['parameters'] if k==n or (p.get('joint') and k==f"{n}_j{p['joint']}")]
                for k in js:
                    v=f['parameters'][k]
                    s=v['sd'] or 1e-9
                    print(w,c[-2:],e['id'],e['form'],k,'true %.4g est %.4g sd %.2g  z %.1f  rel %.2f'%(p['value'],v['value'],s,(v['value']-p['value'])/s,(v['value']/p['value']-1) if p['value'] else 0), len(t['effects']))
