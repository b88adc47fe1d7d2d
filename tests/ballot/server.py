"""The real livery-ballots, phones and an operator, for the tests beside this file."""
import contextlib
import http.client
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import threading

PATIENCE_S = 20


def fail(message):
    print("FAILED: " + message, file=sys.stderr)
    sys.exit(1)


def check(holds, message):
    if not holds:
        fail(message)


class Server:
    """The process, on a port that it keeps over restarts."""

    def __init__(self, program, operator, folder, *options):
        self.program, self.operator_program = program, operator
        self.file = pathlib.Path(folder) / "ballots.sqlite"
        self.options, self.port, self.process = list(options), 0, None
        self.start()

    def start(self):
        self.process = subprocess.Popen(
            [self.program, "--ballots", str(self.file), "--port", str(self.port), "--json", *self.options],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
        line = self.process.stdout.readline()
        check(line, "the server did not start")
        self.place = json.loads(line)
        self.port = self.place["port"]

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def stop(self):
        self.process.terminate()
        code = self.process.wait(PATIENCE_S)
        self.process.stdout.close()
        return code

    def operator(self, *words):
        """One command of the operator's; what it says."""
        done = subprocess.run([self.operator_program, str(self.file), *map(str, words)],
                              capture_output=True, text=True)
        check(done.returncode == 0, f"operator {words}: {done.stderr}")
        return json.loads(done.stdout)

    def memory_kb(self, field="VmHWM"):
        for line in pathlib.Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
            if line.startswith(field + ":"):
                return int(line.split()[1])
        return 0


@contextlib.contextmanager
def serving(*options):
    """A server in a folder of its own; arguments of this script: SERVER OPERATOR."""
    if len(sys.argv) != 3:
        sys.exit(f"usage: {sys.argv[0]} LIVERY_BALLOTS BALLOT_OPERATOR")
    folder = tempfile.mkdtemp(prefix="livery ballots ")
    server = Server(sys.argv[1], sys.argv[2], folder, *options)
    try:
        yield server
    finally:
        if server.process.poll() is None:
            server.kill()
        shutil.rmtree(folder, ignore_errors=True)


class Phone:
    """A browser's part: a cookie, and a connection that is kept. `asks_again` is what browsers do where a kept
    connection has ended meanwhile."""
    asks_again = False

    def __init__(self, server, source="127.0.0.1"):
        self.server, self.source, self.cookie, self.connection = server, source, None, None

    def ask(self, method, path, value=None, headers=None):
        """Status, headers and JSON or text. Raises OSError or HTTPException when nobody answers."""
        own = f"127.0.0.1:{self.server.port}"
        sent = {"Host": own}
        if self.cookie:
            sent["Cookie"] = self.cookie
        body = None
        if value is not None:
            body = value if isinstance(value, (bytes, str)) else json.dumps(value)
            sent.update({"Origin": f"http://{own}", "Sec-Fetch-Site": "same-origin",
                         "Content-Type": "application/json"})
        sent.update(headers or {})
        sent = {name: text for name, text in sent.items() if text is not None}
        kept = self.connection is not None
        try:
            if not self.connection:
                self.connection = http.client.HTTPConnection(
                    "127.0.0.1", self.server.port, timeout=PATIENCE_S, source_address=(self.source, 0))
            self.connection.request(method, path, body, sent)
            answer = self.connection.getresponse()
            text = answer.read().decode()
        except BaseException as problem:
            self.hang_up()
            if kept and self.asks_again and isinstance(problem, (ConnectionError, http.client.RemoteDisconnected)):
                return self.ask(method, path, value, headers)
            raise
        if answer.getheader("Connection", "").lower() == "close":
            self.hang_up()
        if answer.getheader("Set-Cookie"):
            self.cookie = answer.getheader("Set-Cookie").split(";")[0]
        is_json = answer.getheader("Content-Type", "").startswith("application/json") and text
        return answer.status, dict(answer.getheaders()), json.loads(text) if is_json else text

    def hang_up(self):
        if self.connection:
            self.connection.close()
        self.connection = None

    def join(self, token):
        status, headers, _ = self.ask("GET", f"/join/{token}")
        check(status == 303 and headers["Location"] == "/", f"joining: {status} {headers}")
        check(self.cookie, "joining gave no seat")
        state = self.state()
        self.seat = state["seat"]
        return self.seat

    def state(self):
        status, _, state = self.ask("GET", "/state")
        check(status == 200, f"state: {status} {state}")
        return state

    def vote(self, round_, best, second):
        return self.ask("PUT", "/ballot", {"round": round_, "best": best, "second": second})


def at_once(jobs):
    """Runs functions in threads of their own; the first exception of any, once all have ended."""
    problems = []

    def run(job):
        try:
            job()
        except BaseException as problem:  # a failed check is SystemExit
            problems.append(problem)

    threads = [threading.Thread(target=run, args=(job,)) for job in jobs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if problems:
        raise problems[0]


def raw(server, data, source="127.0.0.1", wait_s=PATIENCE_S):
    """Sends bytes on a connection of its own; all that comes back until the server ends it."""
    with socket.create_connection(("127.0.0.1", server.port), wait_s, (source, 0)) as connection:
        answer = b""
        try:
            connection.sendall(data)
            while part := connection.recv(65536):
                answer += part
        except (ConnectionError, BrokenPipeError):
            pass
        return answer


def seed_of(default):
    seed = int(os.environ.get("LIVERY_BALLOT_SEED", default))
    print(f"seed {seed}")
    return seed
