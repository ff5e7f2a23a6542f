import re,collections
mode=None;agg=collections.defaultdict(lambda:[0,0,0.0])
for l in open('/tmp/hp.inst'):
    if l.startswith('FASTEST'): mode='F'; agg['nF'][0]+=1
    elif l.startswith('ENERGY'): mode='E'; agg['nE'][0]+=1
    m=re.match(r'POLISH (\w+) size (\d+) excess (\S+) -> (\S+) steps (\d+) time (\S+) (\w+)',l)
    if m:
        k=(mode,m[1],'ok' if float(m[4])<=0 else 'bad', 'start ok' if float(m[3])<=0 else 'start bad')
        a=agg[k]; a[0]+=1; a[1]+=int(m[5]); a[2]+=float(m[6])
for k,a in agg.items(): print(k,a, '%.2f s each'%(a[2]/max(a[0],1)))
