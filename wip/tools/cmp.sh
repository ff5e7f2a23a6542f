for c in "${@:2}"; do echo "== $c"; $1 /tmp/$c > /tmp/one.json; python3 /tmp/tools/one.py /tmp/one.json;  python3 -c "
import json;d=json.load(open('/tmp/one.json'));print([e['parameters'] for e in d['effects']+d['candidates']])"; done
