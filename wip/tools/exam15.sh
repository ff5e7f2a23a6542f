# exam.sh BIN DIR...: diagnosis.json in each case of the folders, two jobs of one thread
BIN=$1; shift
for d in "$@"; do ls -d $d/case-*; done | xargs -P ${P:-2} -I{} bash -c 'cd {}; [ -s diagnosis.json ] && exit; python3 /tmp/argv.py > d.args 2>/dev/null; s=$(date +%s.%N); RAYON_NUM_THREADS=${T:-1} timeout 1500 '$BIN' diagnose $(cat d.args) --quiet --format json > d.tmp 2> d.err; e=$(date +%s.%N); mv d.tmp diagnosis.json; echo "$e - $s" | bc > d.time'
