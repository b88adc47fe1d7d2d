#!/usr/bin/env python3
"""Gives the real program files that mean harm, and good ones that were damaged, and watches it.

    tests/hostile/run.py build/release/bin/livery                      # what ctest runs: a few of each
    tests/hostile/run.py build/release/bin/livery --all                # 10,000 damaged, every adversarial one
    tests/hostile/run.py PROGRAM --only adversarial --keep DIR --match 'camera.*focal'

A run fails when the program dies of a signal, exits with anything but 0, 1 or 2, takes over 10 seconds of
processor time (60 by the clock) or over a gigabyte without a word of it, answers an error with more than one line
or a library's words, or changes a file outside of --out. --seed (printed) chooses the damage."""
import argparse
import concurrent.futures
import dataclasses
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import adversarial  # noqa: E402
import damage  # noqa: E402
import files  # noqa: E402

CPU_S, CLOCK_S, MEMORY_MB, HARD_MEMORY_MB = 10, 60, 1024, 6144
BATCH = 40  # files that one run looks at
WORDS_OF_LIBRARIES = re.compile(r"bad_alloc|length_error|json\.exception|nlohmann|std::|basic_string|vector::|terminate")


def tree(folder):
    """What would change if anybody wrote there."""
    found = {}
    for base, folders, names in os.walk(folder):
        for name in names + folders:
            path = os.path.join(base, name)
            status = os.lstat(path)
            found[path] = (status.st_size, status.st_mtime_ns, status.st_ino, status.st_mode)
    return found


def limits():
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S + 10, CPU_S + 20))
    resource.setrlimit(resource.RLIMIT_DATA, (HARD_MEMORY_MB << 20, HARD_MEMORY_MB << 20))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def stop_when_stuck(process, late, over):
    """A program that waits for ever uses no processor; one on a busy machine goes on slowly."""
    used = 0.0
    for _ in range(10):
        if over.wait(CLOCK_S):
            return
        try:
            fields = pathlib.Path("/proc/%d/stat" % process).read_text().rsplit(")", 1)[1].split()
        except OSError:
            return
        now = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        if now - used < 0.5:
            break
        used = now
    late.set()
    os.kill(process, signal.SIGKILL)


def prepared(case, work):
    """Lays a case out; its arguments."""
    place = pathlib.Path(work) / case.name
    case.make(place / "in", place)
    (place / "canary").mkdir(exist_ok=True)
    (place / "canary/precious.png").write_bytes(files.png())
    (place / "canary/precious.txt").write_text("precious")
    (place / "home").mkdir(exist_ok=True)
    words = {"{in}": place / "in", "{out}": place / "out", "{place}": place}
    return [re.sub(r"\{(in|out|place)\}", lambda found: str(words[found.group()]), word) for word in case.arguments]


def run_one(program, case, work):
    """Problems that one case shows, in words."""
    return watched(program, case, pathlib.Path(work) / case.name, prepared(case, work))


def run_batch(program, cases, work):
    """Files that are only looked at, many in one run; one by one when that shows a problem."""
    place = pathlib.Path(work) / ("batch-" + cases[0].name)
    place.mkdir()
    try:
        arguments = ["check"]
        for case in cases:
            arguments += prepared(case, place)[1:]
        (place / "home").mkdir()
        (place / "in").mkdir()
        together = dataclasses.replace(cases[0], may_change=tuple(
            case.name + "/" + name for case in cases for name in case.may_change + ("home",)))
        problems, figures = watched(program, together, place, arguments)
    finally:
        shutil.rmtree(place, ignore_errors=True)
    if not problems:
        return [(case, [], {**figures, "arguments": arguments[:2]}) for case in cases]
    found = []
    for case in cases:
        found.append((case, *run_one(program, case, work)))
        if not found[-1][1]:
            shutil.rmtree(pathlib.Path(work) / case.name, ignore_errors=True)
    if not any(problems for _, problems, _ in found):
        found[0][1].append("only with others: %s" % problems)
    return found


def watched(program, case, place, arguments):
    inputs, out = place / "in", place / "out"
    before = tree(place)
    environment = {**os.environ, "LIVERY_HOME": str(place / "home"), "HOME": str(place / "home"),
                   "LIBGL_ALWAYS_SOFTWARE": "1"}
    start = time.monotonic()
    with open(place / "stdout", "wb") as stdout, open(place / "stderr", "wb") as stderr:
        child = subprocess.Popen([program] + arguments, stdin=subprocess.DEVNULL, stdout=stdout, stderr=stderr,
                                 env=environment, cwd=inputs, preexec_fn=limits, start_new_session=True)
        late, over = threading.Event(), threading.Event()
        watcher = threading.Thread(target=stop_when_stuck, args=(child.pid, late, over))
        watcher.start()
        _, status, usage = os.wait4(child.pid, 0)
        over.set()
        watcher.join()
        child.returncode = os.waitstatus_to_exitcode(status)
    seconds = time.monotonic() - start
    cpu = usage.ru_utime + usage.ru_stime
    said = (place / "stdout").read_bytes() + (place / "stderr").read_bytes()
    error = (place / "stderr").read_bytes().decode("utf-8", "replace")
    problems = []
    if late.is_set():
        problems.append("still ran after %d s" % CLOCK_S)
    elif child.returncode < 0:
        problems.append("died of signal %d (%s)" % (-child.returncode, signal.Signals(-child.returncode).name))
    elif child.returncode not in (0, 1, 2):
        problems.append("exit status %d" % child.returncode)
    if cpu > case.cpu_s:
        problems.append("took %.1f s of processor time" % cpu)
    peak = usage.ru_maxrss / 1024
    if peak > MEMORY_MB and not re.search(rb"\d ?GB|memory", said):
        problems.append("took %.0f MB without a word" % peak)
    if child.returncode == 2:
        lines = [line for line in error.splitlines() if not re.match(r" *\d+% ", line)]
        if len(lines) != 1:
            problems.append("%d lines of error" % len(lines))
        if len(error) > 6000:
            problems.append("an error of %d characters" % len(error))
    if WORDS_OF_LIBRARIES.search(error + said.decode("utf-8", "replace")[:100000]):
        problems.append("a library's words: " + WORDS_OF_LIBRARIES.search(error + said.decode("utf-8", "replace")).group())
    own = [str(out), str(place / "home"), str(place / "stdout"), str(place / "stderr")] + [
        str(place / name) for name in case.may_change]
    after = tree(place)
    for path in sorted(set(before) | set(after)):
        if before.get(path) == after.get(path) or any(path == o or path.startswith(o + "/") for o in own):
            continue
        if path + "/" in "".join(o + "/" for o in own) or os.path.isdir(path):
            continue
        problems.append("wrote outside of --out: " + os.path.relpath(path, place))
    if case.exit_codes and child.returncode not in case.exit_codes:
        problems.append("exit status %d, expected %s: %s" % (child.returncode, case.exit_codes, error.strip()[:200]))
    if case.says and not re.search(case.says, said.decode("utf-8", "replace")):
        problems.append("does not say /%s/: %s" % (case.says, error.strip()[:200]))
    return problems, {"seconds": seconds, "cpu": cpu, "mb": peak, "code": child.returncode,
                      "message": error.strip()[:160], "arguments": arguments}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--all", action="store_true", help="every adversarial file, and --damaged of the others")
    parser.add_argument("--damaged", type=int, help="how many damaged inputs (default 150, with --all 10000)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=max(1, os.cpu_count() // 2))
    parser.add_argument("--only", choices=["damaged", "adversarial"])
    parser.add_argument("--match", default="", help="a pattern of case names")
    parser.add_argument("--keep", help="a folder for the cases that fail")
    parser.add_argument("--progress", action="store_true")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    cases = []
    if options.only != "damaged":
        every = adversarial.cases()
        cases += every if options.all or options.match else [c for c in every if c.quick]
    if options.only != "adversarial":
        count = options.damaged if options.damaged is not None else (10000 if options.all else 150)
        cases += damage.cases(options.seed, count)
    cases = [case for case in cases if re.search(options.match, case.name)]
    if options.list:
        print("\n".join(case.name for case in cases))
        return 0
    program = str(pathlib.Path(options.program).resolve())
    print("seed %d, %d cases" % (options.seed, len(cases)), flush=True)
    failed, worst = 0, {"cpu": (0, ""), "mb": (0, "")}
    codes = {}
    with tempfile.TemporaryDirectory(prefix="hostile-") as work:
        made = pathlib.Path(work) / "made.livery"
        subprocess.run([program, "session", "new", str(made), "--product", "sphere"], check=True,
                       stdout=subprocess.DEVNULL, env={**os.environ, "LIVERY_HOME": work})
        files.SESSION = made.read_bytes()

        def some(group):
            if len(group) > 1:
                return run_batch(program, group, work)
            return [(group[0], *run_one(program, group[0], work))]

        def only_looked_at(case):
            return case.arguments[0] == "check" and len(case.arguments) == 2 and not case.exit_codes and not case.says

        looked_at = [case for case in cases if only_looked_at(case) and case.name.startswith("damaged")]
        groups = [[case] for case in cases if not (only_looked_at(case) and case.name.startswith("damaged"))]
        groups += [looked_at[k:k + BATCH] for k in range(0, len(looked_at), BATCH)]
        done = 0
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for future in concurrent.futures.as_completed([pool.submit(some, group) for group in groups]):
                for case, problems, figures in future.result():
                    done += 1
                    codes[figures["code"]] = codes.get(figures["code"], 0) + 1
                    for key in worst:
                        worst[key] = max(worst[key], (round(figures[key], 1), case.name))
                    kept = pathlib.Path(work) / case.name
                    if problems:
                        failed += 1
                        print("FAIL %s: %s\n     %s %s" % (case.name, "; ".join(problems), figures["message"],
                                                           json.dumps(figures["arguments"])), flush=True)
                        if options.keep:
                            shutil.copytree(kept, pathlib.Path(options.keep) / case.name, dirs_exist_ok=True,
                                            symlinks=True, ignore_dangling_symlinks=True,
                                            ignore=lambda _, names: [n for n in names if n.startswith("fifo")])
                    shutil.rmtree(kept, ignore_errors=True)
                if options.progress:
                    print("%d of %d" % (done, len(cases)), file=sys.stderr, flush=True)
    print("%d cases, %d failed; exit statuses %s; most processor time %s, most memory in MB %s" % (
        len(cases), failed, dict(sorted(codes.items())), worst["cpu"], worst["mb"]))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
