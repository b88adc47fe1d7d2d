#!/usr/bin/env python3
"""livery evaluate serve: from joining to the table, with the server killed, then the command itself.

    tests/ballot/serve.py build/release/bin/livery build/release/bin/ballot_operator"""
import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from server import Phone, Server, check

DESIGNS = "red,silver,ivory,blue"


class Serving(Server):
    """As Server, started by the command."""

    def __init__(self, program, operator, folder, what=("--designs", DESIGNS, "--scale", "cheap,precious"),
                 seed=("--seed", "7")):
        self.said, self.token, self.what = [], None, (*what, *seed)
        super().__init__(program, operator, folder)

    def start(self):
        self.process = subprocess.Popen(
            [self.program, "evaluate", "serve", "--ballots", str(self.file), "--port", str(self.port),
             *self.what, "--json"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        found = self.wait_for(r"The ballots are at http://127\.0\.0\.1:(\d+)/")
        self.port = int(found[1])

    def wait_for(self, pattern):
        """Reads what it says until a line has the pattern."""
        while line := self.process.stderr.readline():
            self.said.append(line)
            if found := re.search(pattern, line):
                return found
        print("".join(self.said), file=sys.stderr)
        sys.exit(f"FAILED: it never said {pattern}")

    def enter(self, text=""):
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def children(self):
        return [int(child) for child in
                pathlib.Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()]


def voted(phone, *vote):
    """Until somebody answers."""
    end = time.monotonic() + 20
    while time.monotonic() < end:
        try:
            status, _, answer = phone.vote(*vote)
            check(status == 200, f"{status} {answer}")
            return answer
        except (OSError, http.client.HTTPException):
            time.sleep(0.05)
    sys.exit("FAILED: nobody answers")


def whole(server):
    server.wait_for("Only this machine")
    token = server.wait_for(r"join at http://127\.0\.0\.1:\d+/join/([0-9a-f]{32})$")[1]
    code = server.wait_for(r"join code (\w{4} \w{4})")[1]
    phones = [Phone(server) for _ in range(3)]
    phones[0].join(token)
    phones[1].join(token)
    status, _, answer = phones[2].ask("POST", "/join", {"code": code})
    check(status == 200, f"by code: {status} {answer}")
    server.wait_for("3 have joined")
    server.enter()
    server.wait_for("round 1, seed 7")
    codes = {name: int(server.wait_for(rf"^(\d{{3}})  {name}$")[1]) for name in DESIGNS.split(",")}
    check(phones[0].state()["state"] == "presenting", "not presenting")
    server.wait_for("votes count")
    server.enter()
    server.wait_for("lock the round")
    voted(phones[0], 1, codes["red"], codes["blue"])
    server.wait_for("1 of 3 have voted")
    status, _, answer = phones[0].ask("PUT", "/scales", {"round": 1, "look": codes["red"], "steps": [6]})
    check(status == 200 and answer["ratings"] == {str(codes["red"]): [6]}, f"{status} {answer}")

    # The server is killed: it comes back where it was.
    first = server.children()
    check(len(first) == 1, f"children {first}")
    os.kill(first[0], signal.SIGKILL)
    server.wait_for("started again")
    voted(phones[1], 1, codes["red"], codes["silver"])

    # The command is killed, and with it the server; a new one goes on with the round.
    second = server.children()
    server.kill()
    end = time.monotonic() + 20
    while pathlib.Path(f"/proc/{second[0]}").exists() and time.monotonic() < end:
        time.sleep(0.02)
    check(not pathlib.Path(f"/proc/{second[0]}").exists(), "the server outlives its operator")
    server.process.stderr.close()
    server.start()
    answer = voted(phones[2], 1, codes["silver"], codes["red"])
    check(answer["seat"] in (1, 2, 3), "the seat is gone")
    server.wait_for("3 of 3 have voted")
    server.enter("what")
    server.wait_for("q and Enter ends")
    server.enter()
    server.wait_for("round 1 is locked: 3 ballots")
    server.wait_for("^red,2,1")
    phones[0].hang_up()  # its connection was to the server that was killed
    check(phones[0].state()["state"] == "locked", "not locked")
    server.enter("q")
    out, err = server.process.communicate(timeout=20)
    check(server.process.returncode == 0, f"exit status {server.process.returncode}: {err}")
    told = json.loads(out)
    check(told["seats"] == 3 and told["interface"] == "lo" and not told["tls"], f"{told}")
    round_ = told["rounds"][0]
    check(round_["best"] == [2, 1, 0, 0] and round_["second"] == [1, 1, 0, 1], f"{round_}")
    check(round_["codes"] == list(codes.values()), f"{round_} {codes}")
    return phones


def duel(server, phones):
    """Three repeats of the first two, of which nothing is told before the last, also when it is killed in between."""
    seen = set()
    for repeat in range(3):
        server.wait_for(f"present the two looks, repeat {repeat + 1} of 3")
        server.enter()
        server.wait_for(f"round {repeat + 2}, seed {7 + repeat}")
        codes = {name: int(server.wait_for(rf"^(\d{{3}})  {name}$")[1]) for name in ("red", "silver")}
        seen.update(codes.values())
        server.enter()
        server.wait_for("lock the round")
        for phone in phones:
            phone.hang_up()
            phone.server = server
            voted(phone, repeat + 2, codes["red"], codes["silver"])
        server.wait_for("3 of 3 have voted")
        server.enter()
        if repeat < 2:
            server.wait_for("counts are told with those of the last repeat")
        if repeat == 0:
            server.kill()
            server.process.stderr.close()
            server.start()
    check(len(seen) >= 5, f"codes of repeats: {seen}")
    server.wait_for("3 evaluators with a majority are too few to show a preference between red and silver in a duel")
    server.wait_for("The duel is over")
    server.enter("q")
    out, err = server.process.communicate(timeout=20)
    check(server.process.returncode == 0, f"exit status {server.process.returncode}: {err}")
    series = json.loads(out)["series"]
    check(series["rounds"] == [2, 3, 4] and series["follows"] == 1, f"{series}")
    check(series["majorities"] == [3, 0] and series["consistent"] == 3, f"{series}")


def tally_of_the_duel(program, file):
    done = subprocess.run([program, "evaluate", "tally", "--ballots", str(file), "--json"], capture_output=True, text=True,
                          timeout=60)
    told = json.loads(done.stdout)
    check(told["series"]["majorities"] == [3, 0], f"{told}")
    first = subprocess.run([program, "evaluate", "tally", "--ballots", str(file), "--round", "1", "--json"],
                           capture_output=True, text=True, timeout=60)
    told = json.loads(first.stdout)
    check(told["best"] == [2, 1, 0, 0] and "series" not in told, f"{told}")
    scale = told["scales"][0]
    check(scale["low_word"] == "cheap" and scale["looks"][0]["mean"] == 6 and scale["complete"] == 0, f"{scale}")


def seed_drawn(server):
    server.enter()
    seed = int(server.wait_for(r"round 1, seed (\d+)")[1])
    server.enter("q")
    server.process.communicate(timeout=20)
    return seed


def refusals(program, folder):
    for options, part in ((["--designs", "one"], "at least 2"), (["--interface", "none0"], "none0"),
                          (["--port", "70000"], "70000"), (["--seats", "0"], "--seats"),
                          (["--duel", "--designs", "a,b"], "--duel"), (["--scale", "a,b"], "--designs"),
                          (["--designs", "a,b", "--scale", "alone"], "--scale")):
        done = subprocess.run([program, "evaluate", "serve", "--ballots", os.path.join(folder, "other.sqlite"), *options],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
        check(done.returncode == 2 and part in done.stderr and done.stderr.count("\n") == 1,
              f"{options}: {done.returncode} {done.stderr}")


folder = tempfile.mkdtemp(prefix="livery ballots ")
server = Serving(sys.argv[1], sys.argv[2], folder)
try:
    phones = whole(server)
    server.process.stderr.close()
    server = Serving(sys.argv[1], sys.argv[2], folder, ("--duel",))
    duel(server, phones)
    tally_of_the_duel(sys.argv[1], server.file)
    refusals(sys.argv[1], folder)
    # Without --seed each round draws its own, so that codes cannot be guessed.
    drawn = []
    for _ in range(2):
        server = Serving(sys.argv[1], sys.argv[2], tempfile.mkdtemp(dir=folder), ("--designs", DESIGNS), seed=())
        drawn.append(seed_drawn(server))
    check(drawn[0] != drawn[1], f"seeds {drawn}")
    print("serve: joined, presented, voted, killed twice, locked; a duel in three repeats")
finally:
    if server.process.poll() is None:
        server.process.kill()
        server.process.wait()
    shutil.rmtree(folder, ignore_errors=True)
