cd /work/wt/deferred/fixtures/cells
mkdir -p /tmp/cellout; rm -f /tmp/cells.txt
for f in *; do [ "$f" = README.md ] && continue
 n=${f%.mod}; rm -rf /tmp/cellout/$n
 s=$(date +%s.%N)
 /tmp/relfast/release/joulepath optimize $f --robot IRB1600-10/1.45 --point-estimate --quiet --format json --out /tmp/cellout/$n > /tmp/cellout/$n.json 2>/tmp/cellout/$n.err
 echo "$n rc $? $(echo "$(date +%s.%N)-$s"|bc) putoff $(grep -l 'PutOff:=' /tmp/cellout/$n/Joulepath*.mod 2>/dev/null | wc -l)" >> /tmp/cells.txt
done
