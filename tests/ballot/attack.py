#!/usr/bin/env python3
"""Attacks the server from nine loopback addresses and from the one of twelve honest phones, while these vote: memory
stays bounded, every honest request is answered, and nothing of the attackers' is stored but what a seat may change.

    tests/ballot/attack.py build/release/bin/livery-ballots build/release/bin/ballot_operator
    LIVERY_BALLOT_ATTACK_S=60 tests/ballot/attack.py ...       longer (default 8 s; 60 s with LIVERY_THOROUGH)

Prints how long honest phones waited; the machine's other work is in it."""
import multiprocessing
import os
import random
import socket
import time

from server import Phone, at_once, check, seed_of, serving

SEATS, CLIENTS, MOST_KB = 12, 64, 64 * 1024
ATTACKERS = [f"127.0.0.{k}" for k in range(2, 10)]
STRANGER = "127.0.0.10"
HONEST = "127.0.0.30"
seconds = float(os.environ.get("LIVERY_BALLOT_ATTACK_S", "60" if "LIVERY_THOROUGH" in os.environ else "8"))
seed = seed_of(20261125)


def connected(port, source):
    connection = socket.create_connection(("127.0.0.1", port), 5, (source, 0))
    connection.setblocking(False)
    return connection


def head(port, method="PUT", path="/ballot", headers=""):
    own = f"127.0.0.1:{port}"
    return (f"{method} {path} HTTP/1.1\r\nHost: {own}\r\nOrigin: http://{own}\r\n"
            f"Content-Type: application/json\r\n{headers}").encode()


class Attack:
    """One connection that sends the same for ever, `each` bytes every `every_s`; a new one when it is cut off."""

    def __init__(self, port, source, first, more, every_s):
        self.port, self.source, self.first, self.more, self.every_s = port, source, first, more, every_s
        self.connection, self.next, self.sent = None, 0.0, 0

    def go(self):
        now = time.monotonic()
        if now < self.next:
            return
        self.next = now + self.every_s
        try:
            if not self.connection:
                self.connection = connected(self.port, self.source)
                self.sent += self.connection.send(self.first)
            self.sent += self.connection.send(self.more)
            if not self.connection.recv(65536):
                raise ConnectionError
        except BlockingIOError:
            pass
        except OSError:
            if self.connection:
                self.connection.close()
            self.connection, self.next = None, now + 0.05


def run_for(end, attacks):
    while time.monotonic() < end:
        for attack in attacks:
            attack.go()
        time.sleep(0.002)


def slow_drip(port, end):
    """64 clients, a byte now and then: in headers, in bodies, and in the reading of answers."""
    attacks = []
    for k in range(CLIENTS):
        source = ATTACKERS[k % len(ATTACKERS)]
        kind = k % 3
        first = (head(port), head(port, headers="Content-Length: 1000\r\n\r\n"),
                 head(port, "GET", "/page.js", "\r\n"))[kind]
        attacks.append(Attack(port, source, first, b"x", 0.3 + 0.01 * k))
    # And as many more as an address may hold.
    attacks += [Attack(port, source, b"G", b"E", 1.0) for source in (*ATTACKERS, HONEST) for _ in range(60)]
    run_for(end, attacks)


def endless(port, end):
    """Bodies without end, with and without a length; 100,000 headers; noise."""
    chunk = b"1000\r\n" + b"x" * 4096 + b"\r\n"
    header = b"".join(b"X-%d: %s\r\n" % (k, b"y" * 8) for k in range(100_000))
    noise = random.Random(seed).randbytes(65536)
    run_for(end, [
        Attack(port, ATTACKERS[0], head(port, headers="Transfer-Encoding: chunked\r\n\r\n"), chunk * 16, 0.0),
        Attack(port, ATTACKERS[1], head(port, headers="Content-Length: 999999999\r\n\r\n"), b"x" * 65536, 0.0),
        Attack(port, ATTACKERS[2], head(port), header, 0.0),
        Attack(port, ATTACKERS[3], head(port, "GET", "/"), b"Cookie: " + b"a=b; " * 100_000, 0.0),
        Attack(port, ATTACKERS[4], b"", noise, 0.0),
        Attack(port, ATTACKERS[5], b"GET /" + b"x" * 1000, b"x" * 65536, 0.0),
        # Whole requests, one upon the other, whose answers nobody reads.
        Attack(port, ATTACKERS[6], b"", head(port, "GET", "/page.js", "\r\n") * 50, 0.0),
    ])


INJECTIONS = ["' OR 1=1 --", "'; DROP TABLE ballots; --", "<script>alert(1)</script>", "\"><img src=x>", "../../etc/passwd",
              "%00", "\u2028", "0" * 32, "x" * 900]


def forged(port, end, codes, stolen):
    """Forged Host and Origin, replayed and guessed tokens, SQL and HTML in every field. Nothing may be taken."""
    chance = random.Random(seed)

    class At:  # what Phone asks of a server
        pass

    At.port = port
    guesses = 0
    while time.monotonic() < end:
        phone = Phone(At, chance.choice(ATTACKERS))
        try:
            text = chance.choice(INJECTIONS)
            good = {"round": 1, "best": codes[0], "second": codes[1]}
            for name in ("round", "best", "second", "least", "seat", text):
                check(phone.ask("PUT", "/ballot", {**good, name: text})[0] in (400, 401, 413), f"{name}: {text}")
            for name in ("round", "look", "steps", "seat", text):
                check(phone.ask("PUT", "/scales", {"round": 1, "look": codes[0], "steps": [1], name: text})[0] in
                      (400, 401, 413), f"{name}: {text}")
            for headers in ({"Host": "evil.example"}, {"Host": f"127.0.0.1:{port}.evil.example"}):
                check(phone.ask("PUT", "/ballot", good, headers)[0] == 421, f"{headers}")
            for origin in ("http://evil.example", "null", f"http://127.0.0.1:{port + 1}"):
                # Even with a seat's cookie, as another page would send it.
                check(phone.ask("PUT", "/ballot", good, {"Origin": origin, "Cookie": stolen})[0] == 403, origin)
            for cookie in ("livery-seat=" + f"{chance.getrandbits(128):032x}", "livery-seat=" + text[:30]):
                answer = phone.ask("PUT", "/ballot", good, {"Cookie": cookie.encode("ascii", "replace").decode()})
                check(answer[0] == 401, f"{cookie}: {answer[0]}")
            token = f"{chance.getrandbits(128):032x}"
            check(phone.ask("GET", f"/join/{token}")[0] == 403, "a guessed token")
            check(phone.ask("POST", "/join", {"code": text[:20]})[0] == 403, "a guessed code")
            guesses += 1
        except OSError:
            time.sleep(0.02)  # the address has as many connections as it may
        except Exception as problem:
            if type(problem).__module__ != "http.client":
                raise
        finally:
            phone.hang_up()
    print(f"forged: {guesses} rounds of forged requests, all refused")


def mutated(port, end, codes):
    """Requests as a phone sends them, with bytes changed, taken out, put in and repeated at random."""
    chance = random.Random(seed + 1)
    ballot = b'{"round":1,"best":%d,"second":%d}' % (codes[0], codes[1])
    scales = b'{"round":1,"look":%d,"steps":[4]}' % codes[0]
    length = "Content-Length: {}\r\nCookie: livery-seat=" + "0" * 32 + "\r\nConnection: close\r\n\r\n"
    whole = [head(port, headers=length.format(len(ballot))) + ballot,
             head(port, "PUT", "/scales", length.format(len(scales))) + scales,
             head(port, "POST", "/join", length.format(17)) + b'{"code":"222222"}',
             head(port, "GET", "/join/" + "0" * 32, length.format(0)),
             head(port, "GET", "/state", length.format(0))]
    sent, answers = 0, {}
    while time.monotonic() < end:
        data = bytearray(chance.choice(whole))
        for _ in range(chance.randint(1, 8)):
            at, size, kind = chance.randrange(len(data) + 1), chance.randint(1, 40), chance.randrange(4)
            if kind == 0:
                data[at:at + 1] = chance.randbytes(1)
            elif kind == 1:
                del data[at:at + size]
            else:
                data[at:at] = chance.randbytes(size) if kind == 2 else data[at:at + size]
        sent += 1
        try:
            with socket.create_connection(("127.0.0.1", port), 5, (STRANGER, 0)) as connection:
                connection.sendall(data)
                connection.shutdown(socket.SHUT_WR)
                answer = connection.recv(64)
        except OSError:
            continue
        if answer:
            status = answer.split(b" ", 2)[1].decode("ascii", "replace")
            answers[status] = answers.get(status, 0) + 1
    check(not {"500", "502", "503", "504"} & answers.keys(), f"mutated: {answers}")
    check(len(answers) > 2, f"mutated: only {answers}")
    print(f"mutated: {sent} requests, answered {dict(sorted(answers.items()))}")


def flood(phone, round_, codes, end):
    """A seat that changes its ballot as fast as it can, and wrong join codes all the while."""
    begin, answers = time.monotonic(), {}
    while time.monotonic() < end:
        chosen = codes[len(answers) and answers.get(200, 0) % 2:][:2]
        status = phone.vote(round_, *chosen)[0]
        answers[status] = answers.get(status, 0) + 1
        check(phone.ask("POST", "/join", {"code": "22222222"})[0] == 403, "a wrong code")
    check(answers.keys() <= {200, 429}, f"flood: {answers}")
    most = 61 + (time.monotonic() - begin) * 30 / 60
    check(answers[200] <= most, f"flood: {answers}, expected {most:.0f} at most")
    print(f"flood: answered {answers}")


def honest(phone, round_, codes, end, waits, last, steps):
    """Polls about once a second and votes now and then, as the page does."""
    chance = random.Random(phone.seat)
    while time.monotonic() < end:
        begin = time.monotonic()
        phone.state()
        waits.append(time.monotonic() - begin)
        if chance.random() < 0.1 or phone.seat not in last:
            choice = tuple(chance.sample(codes, 2))
            begin = time.monotonic()
            status, _, answer = phone.vote(round_, *choice)
            waits.append(time.monotonic() - begin)
            check(status == 200, f"an honest vote: {status} {answer}")
            last[phone.seat] = (*choice, answer["receipt"])
            step = chance.randint(1, 7)
            status, _, answer = phone.ask("PUT", "/scales", {"round": round_, "look": codes[0], "steps": [step]})
            check(status == 200, f"an honest answer: {status} {answer}")
            steps[phone.seat] = step
        time.sleep(chance.uniform(0.1, 0.5))


with serving() as server:
    token = server.operator("invitation")["token"]
    Phone.asks_again = True
    phones = [Phone(server, HONEST) for _ in range(SEATS)]
    flooder = Phone(server, ATTACKERS[-1])
    for phone in (*phones, flooder):
        phone.join(token)
    round_ = server.operator("open", "a,b,c,d", "scale=cheap,precious")
    codes = server.operator("show")["rounds"][-1]["codes"]
    quiet_kb = server.memory_kb()

    end = time.monotonic() + seconds
    attackers = [multiprocessing.Process(target=slow_drip, args=(server.port, end)),
                 multiprocessing.Process(target=endless, args=(server.port, end)),
                 multiprocessing.Process(target=flood, args=(flooder, round_, codes, end)),
                 multiprocessing.Process(target=forged, args=(server.port, end, codes, phones[0].cookie)),
                 multiprocessing.Process(target=mutated, args=(server.port, end, codes))]
    for attacker in attackers:
        attacker.start()
    waits, last, steps, open_files = [], {}, {}, []

    def count_connections():
        while time.monotonic() < end:
            open_files.append(len(os.listdir(f"/proc/{server.process.pid}/fd")))
            time.sleep(0.2)

    at_once([count_connections,
             *(lambda phone=phone: honest(phone, round_, codes, end, waits, last, steps) for phone in phones)])
    for attacker in attackers:
        attacker.join()
        check(attacker.exitcode == 0, "an attacker got what it should not")

    check(server.process.poll() is None, "the server has ended")
    peak_kb = server.memory_kb()
    check(0 < peak_kb < MOST_KB, f"memory: {peak_kb} kB")
    server.operator("lock", round_)
    kept = {int(seat): (codes[best], codes[second], receipt)
            for seat, (best, second, receipt) in server.operator("ballots", round_).items()}
    check(kept.pop(flooder.seat, None), "a seat that changes too often may still vote")
    check(kept == last, f"kept {kept}, confirmed {last}")
    answered = {int(seat): placed[str(codes[0])][0] for seat, placed in server.operator("ratings", round_).items()}
    check(answered == steps, f"answers kept {answered}, confirmed {steps}")
    check(server.operator("show")["seats"] == SEATS + 1, "seats that nobody honest took")
    check(max(open_files) > CLIENTS, f"only {max(open_files)} connections: that was no attack")
    waits.sort()
    print(f"attack: {seconds:.0f} s, {len(waits)} honest requests, all answered; waited "
          f"{1000 * waits[len(waits) // 2]:.1f} ms (median), {1000 * waits[-1]:.0f} ms (longest); "
          f"memory {peak_kb} kB at most, {quiet_kb} kB before; {max(open_files)} open files")
    check(server.stop() == 0, "it did not end well")
