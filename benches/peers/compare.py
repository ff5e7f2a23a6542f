"""Compares `joulepath parse` with rapidchecker on the same files.

    pip install rapidchecker==0.1.5
    cargo build --release
    python3 benches/peers/compare.py [FILE or FOLDER …]

Both run on one core and are timed without the start of their process where
that can be told apart: rapidchecker by the time of its calls, joulepath by the
time of one process for all files, start included.
"""

import json
import pathlib
import subprocess
import sys
import time

from rapidchecker.check import check_format
from rapidchecker.config import CONFIG

# Only its grammar check is compared.
CONFIG.indentation_check = False
CONFIG.require_uppercase_keywords = False

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHIPPED = ["hard", "paper", "pick_place", "syntax/ok"]
ENDINGS = {".mod", ".sys", ".prg"}


def files(arguments):
    for argument in arguments or [ROOT / "fixtures" / folder for folder in SHIPPED]:
        path = pathlib.Path(argument)
        inside = path.rglob("*") if path.is_dir() else [path]
        yield from sorted(file for file in inside if file.suffix.lower() in ENDINGS)


def text(path):
    data = path.read_bytes()
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def peer(paths):
    """Files without an error, and seconds."""
    accepted, seconds = 0, 0.0
    for path in paths:
        content = text(path)
        start = time.perf_counter()
        try:
            accepted += not check_format(content)
        except Exception:  # A crash of the peer is no acceptance.
            pass
        seconds += time.perf_counter() - start
    return accepted, seconds


def ours(paths):
    binary = ROOT / "target" / "release" / "joulepath"
    start = time.perf_counter()
    result = subprocess.run(
        [binary, "parse", "--format", "json", *paths],
        capture_output=True,
        check=False,
        env={"RAYON_NUM_THREADS": "1"},
    )
    seconds = time.perf_counter() - start
    totals = json.loads(result.stdout)["totals"]
    return totals["files"] - totals["files_with_errors"], seconds


def main():
    sys.setrecursionlimit(10_000)
    paths = list(files(sys.argv[1:]))
    size = sum(path.stat().st_size for path in paths)
    print(f"{len(paths)} files, {size} bytes")
    for name, (accepted, seconds) in [("rapidchecker", peer(paths)), ("joulepath", ours(paths))]:
        rate = size / seconds / 1e6
        print(f"{name:13} accepts {accepted:4}   {seconds:8.3f} s   {rate:8.3f} MB/s")


if __name__ == "__main__":
    main()
