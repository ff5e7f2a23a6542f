# sub.sh BIN OUT cases...
BIN=$1; OUT=$2; shift 2; : > $OUT
printf '%s\n' "$@" | xargs -P 2 -I{} bash -c 'bash /tmp/rc.sh '$BIN' {} >> '$OUT' 2>&1'
echo finished >> $OUT
