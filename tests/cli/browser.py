"""Headless Chromium through its debugging pipe: pages as a reader sees them, with the standard library alone."""

import base64
import json
import os
import pathlib
import select
import shutil
import signal
import subprocess
import time

from harness import Failed, Skipped, check

NAMES = ("chromium", "chromium-browser", "google-chrome")
TIMEOUT = 60.0  # seconds for one answer


class Browser:
    """Used as `with Browser(folder) as browser`. The folder holds its profile. webgl: pages draw by WebGL and WebGPU on the CPU."""

    def __init__(self, folder, webgl=False):
        program = next(filter(None, map(shutil.which, NAMES)), None)
        if not program:
            raise Skipped("no Chromium: package chromium, group test of apps/packages.txt")
        command_out, self.command = os.pipe()
        self.answers, answers_in = os.pipe()

        def place_pipes():  # the browser reads commands from 3 and answers on 4
            os.dup2(command_out, 103)
            os.dup2(answers_in, 104)
            os.dup2(103, 3)
            os.dup2(104, 4)

        self.process = subprocess.Popen(
            [program, "--headless=new", "--remote-debugging-pipe", "--no-sandbox",
             *(("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader") if webgl else ("--disable-gpu",)), "--hide-scrollbars", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-dev-shm-usage", f"--user-data-dir={folder}/profile", "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, close_fds=False, preexec_fn=place_pipes,
            start_new_session=True, env={**os.environ, "HOME": str(folder)})
        os.close(command_out)
        os.close(answers_in)
        self.number, self.buffer, self.session = 0, b"", None
        self.faults = []    # errors on the page's console
        self.requests = []  # addresses requested by the page
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.send(domain + ".enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            os.killpg(self.process.pid, signal.SIGKILL)  # with its children
        except ProcessLookupError:
            pass
        self.process.wait()
        os.close(self.command)
        os.close(self.answers)

    def message(self):
        begin = time.monotonic()
        while b"\0" not in self.buffer:
            left = TIMEOUT - (time.monotonic() - begin)
            ready = select.select([self.answers], [], [], max(0.0, left))[0]
            part = os.read(self.answers, 1 << 20) if ready else b""
            if not part:
                raise Failed("Chromium says nothing")
            self.buffer += part
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def send(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        text = json.dumps(message).encode() + b"\0"
        while text:
            text = text[os.write(self.command, text):]
        while True:
            answer = self.message()
            self.note(answer)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise Failed(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def note(self, event):
        method, parameters = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.faults.append(details.get("exception", {}).get("description") or details["text"])
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            self.faults.append(f"console.{parameters['type']}")
        elif method == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            self.faults.append(parameters["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(parameters["request"]["url"])

    def open(self, path):
        self.send("Page.navigate", url=pathlib.Path(path).resolve().as_uri())
        self.until("document.readyState === 'complete' && location.protocol === 'file:'")
        self.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))")  # a page gets no input before its first frame

    def visit(self, address):
        """Opens a page of a server."""
        self.send("Page.navigate", url=address)
        self.until("document.readyState === 'complete' && location.protocol === 'http:'")

    def value(self, expression):
        result = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise Failed(f"{expression}: {result['exceptionDetails'].get('exception', {}).get('description')}")
        return result["result"].get("value")

    def until(self, expression, seconds=30.0):
        begin = time.monotonic()
        while not self.value(expression):
            check(time.monotonic() - begin < seconds, f"never true: {expression}")
            time.sleep(0.05)

    def size(self, width, height):
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 500)

    def scheme(self, name):
        self.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def mouse(self, kind, x, y, **more):
        self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def press(self, key, code=None, number=0, text=None):
        """Presses a real key. The focused element receives it."""
        more = {"text": text} if text else {}
        self.send("Input.dispatchKeyEvent", type="keyDown", key=key, code=code or key, windowsVirtualKeyCode=number, **more)
        self.send("Input.dispatchKeyEvent", type="keyUp", key=key, code=code or key, windowsVirtualKeyCode=number)

    def screenshot(self, path, whole=True):
        shot = self.send("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        pathlib.Path(path).write_bytes(base64.b64decode(shot["data"]))
