cd /work/wt/gap; export INSTA_UPDATE=no CI=true
bins=$(grep -oE "\(/work[^)]*\)" /tmp/build.log | tr -d '()')
rm -rf /tmp/tt3 /tmp/part3.log; mkdir /tmp/tt3
one() { b=$1; t=$(basename $b); s=$(date +%s); timeout 400 $b > /tmp/tt3/$t.log 2>&1; r=$?; echo "## $t rc $r $(( $(date +%s) - s )) s: $(grep -E '^test result' /tmp/tt3/$t.log | tail -1)" >> /tmp/part3.log; grep -E "^test .*FAILED" /tmp/tt3/$t.log >> /tmp/part3.log; }
export -f one
for b in $bins; do case $(basename $b) in gap-*|claims-*|shared_data-*|all_robots-*) ;; *) echo $b;; esac; done | xargs -P 2 -I{} bash -c 'one {}'
echo done >> /tmp/part3.log
