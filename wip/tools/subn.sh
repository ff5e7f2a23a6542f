BIN=$1; OUT=$2; shift 2; : > $OUT
for c in "$@"; do RAYON_NUM_THREADS=1 nice -n 19 bash /tmp/rc.sh $BIN $c >> $OUT 2>&1; done; echo finished >> $OUT
