import re,sys
# sequences
seq=[];out=[]
lines=open(sys.argv[1]).read().splitlines()
tot=0; groups=[]; cur=None
for l in lines:
    if l.startswith(('ENERGY','FASTEST')):
        cur={'h':l,'a':[], 'end':None}; groups.append(cur)
    m=re.match(r'POLISH (\w+) size (\d+) excess (\S+) -> (\S+) merit (\S+) -> (\S+) steps (\d+) time (\S+) (\w+) worst (\S+)',l)
    if m and cur is not None:
        cur['a'].append([float(m[3]),float(m[4]),int(m[7]),float(m[8]),m[9],float(m[10]),'?']); tot+=float(m[8])
    if l.strip().startswith(('FAULT','HOLDS','HOPELESS')) and cur is not None and cur['a']:
        cur['a'][-1][6]=l.split()[0] + (' '+l.split('would be ')[1].split(' %')[0] if 'would be' in l else '')
print('total polish',tot)
n={'held':[0,0.],'lost':[0,0.]}
for g in groups:
    held=any(a[6]=='HOLDS' for a in g['a'])
    t=sum(a[3] for a in g['a'])
    k='held' if held else 'lost'; n[k][0]+=1; n[k][1]+=t
    print(g['h'],k,'%.1f s'%t,' | '.join('%.2f>%.3f %d %s'%(a[0],a[1],a[2],a[6]) for a in g['a'][:24]))
print(n)
