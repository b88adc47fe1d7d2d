"""Chromium without a window, by its DevTools protocol over a pipe: no port, no other program."""
import base64
import json
import os
import select
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

PROGRAMS = ("chromium-headless-shell", "chromium-shell", "chromium")
PATIENCE_S = 20


def find_browser():
    for name in PROGRAMS:
        if path := shutil.which(name):
            return path
    sys.exit(f"none of {', '.join(PROGRAMS)} is installed")


class Browser:
    def __init__(self, program):
        self.profile = tempfile.mkdtemp(prefix="livery-chromium-")
        to_browser, self.writing = os.pipe()
        self.reading, from_browser = os.pipe()

        def as_three_and_four():
            # By way of numbers that neither is.
            os.dup2(to_browser, 30)
            os.dup2(from_browser, 31)
            os.dup2(30, 3)
            os.dup2(31, 4)

        arguments = [program, "--headless", "--remote-debugging-pipe", f"--user-data-dir={self.profile}",
                     "--disable-gpu", "--no-first-run", "--disable-extensions", "--disable-component-update",
                     "--disable-background-networking", "--hide-scrollbars", "--force-color-profile=srgb",
                     "--disable-dev-shm-usage"]
        if os.geteuid() == 0:
            arguments.append("--no-sandbox")
        self.process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL, preexec_fn=as_three_and_four, close_fds=False)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer, self.number, self.events = b"", 0, []

    def close(self):
        try:
            self.call("Browser.close")
        except (OSError, TimeoutError, RuntimeError):
            pass
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.writing)
        os.close(self.reading)
        shutil.rmtree(self.profile, ignore_errors=True)

    def read(self, until):
        """The next message, or nothing when none has come by then."""
        while b"\0" not in self.buffer:
            left = until - time.monotonic()
            if left <= 0 or not select.select([self.reading], [], [], left)[0]:
                return None
            part = os.read(self.reading, 1 << 20)
            if not part:
                raise RuntimeError("the browser has ended")
            self.buffer += part
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, session=None, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.writing, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + PATIENCE_S
        while (answer := self.read(until)) is not None:
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            if "method" in answer:
                self.events.append(answer)
        raise TimeoutError(f"{method}: no answer")

    def phone(self, width=390, height=844):
        """A phone of its own: no cookie of another's."""
        context = self.call("Target.createBrowserContext")["browserContextId"]
        target = self.call("Target.createTarget", url="about:blank", browserContextId=context)["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        tab = Tab(self, session)
        for domain in ("Page", "Runtime", "Network", "Log", "DOM", "Accessibility"):
            tab.call(f"{domain}.enable")
        tab.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2, mobile=True)
        tab.call("Emulation.setTouchEmulationEnabled", enabled=True)
        return tab


class Tab:
    def __init__(self, browser, session):
        self.browser, self.session, self.taps = browser, session, 0

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def events(self, method):
        return [event["params"] for event in self.browser.events
                if event.get("sessionId") == self.session and event["method"] == method]

    def js(self, expression):
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def go(self, url):
        answer = self.call("Page.navigate", url=url)
        if answer.get("errorText"):
            raise RuntimeError(f"{url}: {answer['errorText']}")

    def leave(self, method, **parameters):
        """Calls what leaves the page, and waits for another one: the old one could still answer."""
        self.js("window.left = true")
        self.call(method, **parameters)
        self.wait("!window.left && document.readyState === 'complete'", "another page")

    def wait(self, expression, what, patience_s=PATIENCE_S):
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            try:
                if self.js(expression):
                    return
            except RuntimeError:  # between two pages
                pass
            time.sleep(0.02)
        print(f"FAILED: waited in vain for {what}; on screen: {self.js('document.body.innerText')!r}", file=sys.stderr)
        sys.exit(1)

    def view(self):
        return self.js("[...document.querySelectorAll('section')].filter(s => !s.hidden).map(s => s.dataset.view).join()")

    def wait_for_view(self, view):
        self.wait("[...document.querySelectorAll('section')].filter(s => !s.hidden).map(s => s.dataset.view).join() "
                  f"=== {json.dumps(view)}", f"the view {view}")

    def tap(self, selector):
        """A finger in the middle of it; scrolls there first, as a person would."""
        place = self.js(f"""(() => {{ const e = document.querySelector({json.dumps(selector)});
            e.scrollIntoView({{block: "nearest"}}); const r = e.getBoundingClientRect();
            return [r.x + r.width / 2, r.y + r.height / 2]; }})()""")
        point = [{"x": place[0], "y": place[1]}]
        self.call("Input.dispatchTouchEvent", type="touchStart", touchPoints=point)
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.taps += 1

    def key(self, key, code=None, number=0, text=None):
        for kind in ("keyDown", "keyUp"):
            extra = {"text": text} if text and kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=code or key, windowsVirtualKeyCode=number, **extra)

    def window(self, state):
        window = self.call("Browser.getWindowForTarget")["windowId"]
        self.browser.call("Browser.setWindowBounds", windowId=window, bounds={"windowState": state})

    def sleep(self):
        """As a phone in a pocket: hidden, and no timer runs."""
        self.window("minimized")
        self.wait("document.hidden", "a hidden page")
        self.call("Page.setWebLifecycleState", state="frozen")

    def wake(self):
        self.call("Page.setWebLifecycleState", state="active")
        self.window("normal")

    def picture(self, scale=1.0):
        """The screen as PNG; scale 1: two pixels a CSS pixel."""
        clip = {"x": 0, "y": 0, "width": 390, "height": 844, "scale": scale}
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", clip=clip)["data"])


def png_pixels(data):
    """(r, g, b) of every pixel of a PNG as Chromium writes them: eight bits, RGB or RGBA, not interlaced."""
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            channels = {2: 3, 6: 4}[colour]
            assert depth == 8 and not interlaced
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    rows, stride = zlib.decompress(packed), width * channels
    before, pixels = bytearray(stride), []
    for y in range(height):
        kind, row = rows[y * (stride + 1)], bytearray(rows[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for k in range(stride):
            left = row[k - channels] if k >= channels else 0
            up, corner = before[k], before[k - channels] if k >= channels else 0
            if kind == 4:
                guess = left + up - corner
                near = min((abs(guess - left), 0), (abs(guess - up), 1), (abs(guess - corner), 2))[1]
                row[k] = (row[k] + (left, up, corner)[near]) & 255
            else:
                row[k] = (row[k] + (0, left, up, (left + up) // 2)[kind]) & 255
        pixels += [tuple(row[k:k + 3]) for k in range(0, stride, channels)]
        before = row
    return pixels
