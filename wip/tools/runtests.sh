cd /work/wt/gap; export INSTA_UPDATE=no
bin() { grep -oE "tests/($1)(\.rs|/main\.rs) \(([^)]*)\)" /tmp/build.log | grep -oE "/work[^)]*"; }
for t in layers lints contributing effects_page effects architecture diagnose_command report log motion_channel dirty_logs gap identify identify_command predict_command other_forms worlds blind claims inputs_kept robot robot_import hostile reasons coverage shared_data calibrate identify_robots; do
  b=$(bin $t); [ -z "$b" ] && { echo "## $t none" >> /tmp/part.log; continue; }
  s=$(date +%s); timeout 1500 $b > /tmp/t_$t.log 2>&1; r=$?; echo "## $t rc $r $(( $(date +%s) - s )) s: $(grep -E '^test result' /tmp/t_$t.log)" >> /tmp/part.log; grep -E "^test .*FAILED" /tmp/t_$t.log >> /tmp/part.log
done; echo done >> /tmp/part.log
