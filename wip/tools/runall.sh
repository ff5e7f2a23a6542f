cd /work/wt/gap; export INSTA_UPDATE=no CI=true
first="layers lints claims shared_data gap diagnose_command report"
bins=$(grep -oE "\(/work[^)]*\)" /tmp/build.log | tr -d '()')
run() { b=$1; t=$(basename $b); s=$(date +%s); d=/work/wt/gap; timeout 1500 $b > /tmp/tt/$t.log 2>&1; r=$?; echo "## $t rc $r $(( $(date +%s) - s )) s: $(grep -E '^test result' /tmp/tt/$t.log)" >> /tmp/part2.log; grep -E "^test .*FAILED" /tmp/tt/$t.log >> /tmp/part2.log; }
rm -rf /tmp/tt /tmp/part2.log; mkdir /tmp/tt
for f in $first; do for b in $bins; do case $(basename $b) in $f-*) run $b;; esac; done; done
for b in $bins; do t=$(basename $b); n=${t%-*}; echo " $first " | grep -q " $n " || { case $b in */joulepath_py*|*python*) ;; *) run $b;; esac; }; done
echo done >> /tmp/part2.log
