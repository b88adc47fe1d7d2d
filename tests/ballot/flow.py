#!/usr/bin/env python3
"""A vote from the QR code to the locked round, over loopback: twelve seats at once, and what HTTP may not do.

    tests/ballot/flow.py build/release/bin/livery-ballots build/release/bin/ballot_operator"""
import http.client
import json
import socket
import ssl
import subprocess
import time

from server import Phone, at_once, check, raw, serving

SEATS = 12


def vote_of_twelve(server):
    token = server.operator("invitation")["token"]
    phones = [Phone(server) for _ in range(SEATS)]
    at_once([lambda phone=phone: phone.join(token) for phone in phones])
    check(sorted(phone.seat for phone in phones) == list(range(1, SEATS + 1)), "seats are not 1 to 12")
    for phone in phones:
        check(phone.state()["state"] == "waiting", "not waiting")

    round_ = server.operator("open", "a,b,c,d", "present")
    check(all(phone.state()["state"] == "presenting" for phone in phones), "not presenting")
    late = Phone(server)
    check(late.ask("GET", f"/join/{token}")[0] == 303 and not late.cookie, "a seat after the round began")
    server.operator("voting", round_)
    codes = phones[0].state()["codes"]
    check(codes == sorted(codes) and len(set(codes)) == 4, f"codes: {codes}")

    confirmed = {}

    def vote(phone):
        # Everybody votes, sends it twice, and changes it.
        for k in range(3):
            best, second = codes[(phone.seat + k) % 4], codes[(phone.seat + k + 1) % 4]
            first = phone.vote(round_, best, second)
            again = phone.vote(round_, best, second)
            check(first[0] == again[0] == 200, f"vote: {first}")
            check(first[2] == again[2], "sent twice, it is another vote")
            confirmed[phone.seat] = (best, second, first[2]["receipt"])
            phone.hang_up()  # a reload

    at_once([lambda phone=phone: vote(phone) for phone in phones])
    for phone in phones:
        ballot = phone.state()["ballot"]
        check((ballot["best"], ballot["second"]) == confirmed[phone.seat][:2], "another ballot after a reload")
    server.operator("lock", round_)
    check(phones[0].vote(round_, *codes[:2])[0] == 409, "a vote after the lock")
    check(phones[0].state()["state"] == "locked", "not locked")
    shown = server.operator("show")["rounds"][0]
    check(shown["codes"] and sorted(shown["codes"]) == codes, "other codes")
    kept = {int(seat): (shown["codes"][best], shown["codes"][second], receipt)
            for seat, (best, second, receipt) in server.operator("ballots", round_).items()}
    check(kept == confirmed, f"kept {kept}, confirmed {confirmed}")


def protocol(server):
    own = f"127.0.0.1:{server.port}"
    phone = Phone(server)
    for path in ("/", "/page.js", "/page.css", "/state", "/nothing"):
        _, headers, _ = phone.ask("GET", path)
        policy = headers["Content-Security-Policy"]
        for part in ("default-src 'none'", "script-src 'self'", "style-src 'self'", "connect-src 'self'",
                     "frame-ancestors 'none'", "form-action 'none'", "base-uri 'none'"):
            check(part in policy, f"{path}: no {part}")
        check("unsafe" not in policy and "*" not in policy, f"{path}: {policy}")
        for name, value in (("Cache-Control", "no-store"), ("Referrer-Policy", "no-referrer"),
                            ("X-Content-Type-Options", "nosniff")):
            check(headers[name] == value, f"{path}: {name}")

    def status(data):
        answer = raw(server, data)
        return int(answer.split()[1]) if answer.startswith(b"HTTP/1.1 ") else 0

    def request(method="PUT", path="/ballot", headers="", body=b"", host=own):
        text = f"{method} {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n{headers}\r\n"
        return text.encode() + body

    origin = f"Origin: http://{own}\r\nContent-Type: application/json\r\n"
    check(status(request(headers=origin + "Content-Length: 1025\r\n", body=b"x" * 1025)) == 413, "1025 bytes")
    check(status(request(headers=origin + "Content-Length: 1024\r\n", body=b"x" * 1024)) == 401, "1024 bytes")
    check(status(request(headers=origin + "Content-Length: 99999999999999999999\r\n")) in (400, 413), "long length")
    check(status(request(headers=origin + "Transfer-Encoding: chunked\r\n", body=b"1\r\nx\r\n0\r\n\r\n")) == 411, "chunks")
    check(status(request("GET", "/state", host="evil.example")) == 421, "another Host")
    check(status(b"GET /state HTTP/1.1\r\nConnection: close\r\n\r\n") == 400, "no Host")
    check(status(request("GET", "/join/" + "0" * 32)) == 403, "a guessed token")
    check(status(request("GET", "/join/%27%20OR%201=1")) == 403, "an injected token")
    check(status(request("TRACE", "/state")) == 405, "TRACE")
    check(status(request("GET", "/" + "x" * 40000)) in (0, 414, 431), "a long path")

    # Deadlines: of headers, and of a body that trickles.
    for data, least_s, most_s, what in ((b"GET /state HTTP/1.1\r\nHo", 1.5, 5.0, "headers"),
                                        (request(headers=origin + "Content-Length: 900\r\n"), 4.0, 14.0, "body")):
        with socket.create_connection(("127.0.0.1", server.port), 30) as slow:
            begin = time.monotonic()
            slow.sendall(data)
            try:
                while time.monotonic() - begin < 30:
                    slow.settimeout(0.2)
                    try:
                        if not slow.recv(4096):
                            break
                    except TimeoutError:
                        slow.sendall(b"x")
            except ConnectionError:
                pass
            took = time.monotonic() - begin
        # An upper bound alone says that it ends; the machine may be busy.
        check(least_s < took < 30, f"slow {what}: cut off after {took:.1f} s, expected about {least_s} to {most_s}")
        print(f"slow {what}: cut off after {took:.1f} s")


def encrypted(plain):
    """The same with a certificate: a seat whose cookie never leaves encryption."""
    folder = plain.file.parent
    plain.operator("certificate", folder)
    with serving("--certificate", folder / "certificate.pem", "--key", folder / "key.pem") as server:
        check(server.place["url"].startswith("https://"), f"{server.place}")
        trust = ssl.create_default_context(cafile=folder / "certificate.pem")

        def ask(method, path, headers, body=None):
            connection = http.client.HTTPSConnection("127.0.0.1", server.port, timeout=20, context=trust)
            connection.request(method, path, body, {"Host": f"127.0.0.1:{server.port}", **headers})
            answer = connection.getresponse()
            text = answer.read()
            connection.close()
            return answer, text

        joined, _ = ask("GET", "/join/" + server.operator("invitation")["token"], {})
        cookie = joined.getheader("Set-Cookie")
        check(joined.status == 303 and cookie.endswith("; Secure"), f"{joined.status} {cookie}")
        round_ = server.operator("open", "a,b")
        codes = server.operator("show")["rounds"][0]["codes"]
        body = json.dumps({"round": round_, "best": codes[0], "second": codes[1]})
        for scheme, status in (("http", 403), ("https", 200)):
            answer, text = ask("PUT", "/ballot", {"Cookie": cookie.split(";")[0], "Content-Type": "application/json",
                                                  "Origin": f"{scheme}://127.0.0.1:{server.port}"}, body)
            check(answer.status == status, f"{scheme}: {answer.status} {text}")
        # Plain HTTP gets nothing, and whoever never finishes the handshake is cut off.
        check(not raw(server, b"GET / HTTP/1.1\r\nHost: x\r\n\r\n").startswith(b"HTTP"), "plain HTTP")
        begin = time.monotonic()
        raw(server, b"\x16\x03\x01")
        check(time.monotonic() - begin < 15, "a handshake that never ends")
        check(server.memory_kb() < 64 * 1024, "memory")
        check(server.stop() == 0, "it did not end well")


def failures(server):
    def refused(*options):
        done = subprocess.run([server.program, *options], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                              timeout=20)
        check(done.returncode == 2 and done.stderr.count("\n") == 1 and not done.stdout,
              f"{options}: {done.returncode} {done.stderr}")
        return done.stderr

    file = str(server.file)
    check("expected a file" in refused(), "no file")
    check("lo (127.0.0.1)" in refused("--ballots", file, "--interface", "none0"), "no such interface")
    check("--port" in refused("--ballots", file, "--port", str(server.port)), "port in use")
    check("0 to 65535" in refused("--ballots", file, "--port", "x"), "no port")
    check("--key" in refused("--ballots", file, "--certificate", "a.pem"), "a certificate alone")
    check("PEM" in refused("--ballots", file, "--port", "0", "--certificate", __file__, "--key", __file__), "no certificate")
    check("no folder" in refused("--ballots", str(server.file.parent / "none" / "x"), "--port", "0"), "no folder")
    check("--frob" in refused("--frob"), "unknown option")


with serving() as server:
    vote_of_twelve(server)
    protocol(server)
    encrypted(server)
    failures(server)
    limits = open(f"/proc/{server.process.pid}/limits", encoding="ascii").read()
    for line in ("Max core file size        0", "Max processes             0", "Max data size             67108864"):
        check(line in limits, f"limit: {line}")
    check(server.stop() == 0, "it did not end well")
    print("flow: twelve seats, three votes each, sent twice: all kept, none twice")
