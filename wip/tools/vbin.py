import collections,math,sys
d=collections.defaultdict(list)
rows=[list(map(float,l.split())) for l in sys.stdin if l[0]!='#']
m=max(abs(r[2]) for r in rows)
for x in rows:
    if x[7]: d[round(x[2]/m*10)].append(x[6]-x[5])
for k in sorted(d):
    r=d[k];a=sum(r)/len(r);print(round(k/10*m,2),len(r),round(a,2),round(math.sqrt(sum((x-a)**2 for x in r)/len(r)),2))
