import json,sys
for p in sys.argv[1:]:
    d=json.load(open(f'/work/wt/reach_out/{p}.json')); print('==',p)
    for s in d['segments']:
        if s['kind']=='timing': print(f"{s['file'].split('/')[-1]}:{s['line_first']}-{s['line_last']} x{s['executions']}/{s['rewritten_executions']} {s['time_before_s']:.2f}s {'REWRITTEN' if s['rewritten'] else s['reason']}"[:330])
    for u in d['unresolved']: print('   U',u['line'],u['reason'][:200])
    for n in d['notes']: print('   N',n)
