"""burnish serve: a page on this machine that draws, under a token, and writes nothing unasked."""

import http.client
import json
import os
import pathlib
import shlex
import shutil
import signal
import socket
import subprocess
import threading
import time
import urllib.parse

from browser import Browser
from harness import Failed, case, check

SMALL_LIGHT = {"--env-size": "16", "--env-samples": "16", "--floor": "off", "--msaa": "1"}


class Served:
    """A running `burnish serve` and its address."""

    def __init__(self, bench, *words):
        self.process = subprocess.Popen([bench.program, "serve", *words], cwd=bench.folder, env=bench.environment({}), stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        parts = urllib.parse.urlsplit(self.address)
        self.port, self.token = parts.port, parts.query.removeprefix("token=")

    def __enter__(self):
        check(self.token, f"no address: {self.process.stderr.read() if self.process.poll() is not None else ''}")
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        try:
            code = self.process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        check(code == 0, f"it ended with {code}: {self.process.stderr.read()}")

    def ask(self, path, body=None, **headers):
        """Returns status, headers and body of an answer."""
        link = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        sent = {"X-Token": self.token, **{name.replace("_", "-"): value for name, value in headers.items()}}
        link.request("GET" if body is None else "POST", path, body if body is None or isinstance(body, (str, bytes)) else json.dumps(body), sent)
        answer = link.getresponse()
        return answer.status, answer.headers, answer.read()


    def ask_for_nothing(self, body):
        """Sends a request whose answer is of no interest."""
        try:
            self.ask("/draw", body)
        except OSError:
            pass


def cpu_seconds(process):
    fields = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def wish(scene="builtin:sphere", size=(64, 48), **options):
    return {"scene": scene, "environment": "builtin:studio", "width": size[0], "height": size[1],
            "options": {**SMALL_LIGHT, **{"--" + name.replace("_", "-"): value for name, value in options.items()}}}


def hash_of_command(bench, command):
    words = shlex.split(command)
    check(words[:2] == ["burnish", "render"], command)
    return json.loads(bench.run("render", *words[2:], "--stats", "-", "-q").expect(0).out)["pixel_hash"]


@case("serve.pictures_are_those_of_the_command_it_names", budget=10)
def pictures(bench):
    with Served(bench, "builtin:sphere") as served:
        for more in ({}, {"roughness": "0.3", "anisotropy": "0.8"}, {"technique": "mc", "samples": "4"}, {"orbit": "20,40", "zoom": "1.5", "no_background": ""}, {"msaa": "8", "roughness": "0.2"},
                     {"floor": "stage"}, {"floor": "stage", "no_background": ""}, {"frame_map": "off"}):
            status, headers, body = served.ask("/draw", wish(**more))
            check(status == 200 and body.startswith(b"\x89PNG"), f"{more}: {status} {body[:200]}")
            info = json.loads(headers["X-Burnish"])
            check(info["hash"] == hash_of_command(bench, info["command"]), f"{info['command']} draws another picture")
            (bench.folder / "served.png").write_bytes(body)
            bench.run("compare", "served.png", "picture.png", "--fail-max", "0", "-q").expect(0)
        # Warnings belong to this picture, not to the session
        for words, told in (({"shadows": "ratio"}, True), ({}, False), ({"shadows": "ratio"}, True)):
            info = json.loads(served.ask("/draw", wish(**words))[1]["X-Burnish"])
            check(any("--shadows has no effect" in line for line in info["warnings"]) == told, f"{words}: {info['warnings']}")
        # A quarter of the sides
        info = json.loads(served.ask("/draw", {**wish(), "reduction": 4})[1]["X-Burnish"])
        check((info["width"], info["height"]) == (16, 12) and info["hash"] == hash_of_command(bench, info["command"]), str(info))
        # The reference, and the difference of two settings
        info = json.loads(served.ask("/draw", {**wish(size=(16, 12)), "reference_samples": 64})[1]["X-Burnish"])
        check(info["samples"] == 64 and not info["warnings"] and info["hash"] == hash_of_command(bench, info["command"]), str(info))
        status, headers, _ = served.ask("/difference", {"reference": wish(), "test": wish(roughness="0.3")})
        found = json.loads(headers["X-Burnish"])
        check(status == 200 and 0.001 < found["flip_mean"] < found["flip_p99"], str(found))
        check(json.loads(served.ask("/difference", {"reference": wish(), "test": wish()})[1]["X-Burnish"])["flip_mean"] == 0, "a picture differs from itself")


@case("serve.references_stop_for_other_pictures", budget=20)
def stopped(bench):
    """References work on all cores until they stop."""
    long = {**wish(size=(640, 480)), "reference_samples": 65536}
    with Served(bench, "builtin:sphere") as served:
        answers = []
        waiting = threading.Thread(target=lambda: answers.append(served.ask("/draw", long)[0]))
        waiting.start()
        time.sleep(0.5)
        check(served.ask("/draw", wish())[0] == 200, "a picture beside a reference")
        waiting.join(timeout=30)
        check(answers == [409], f"the reference ended with {answers}")
        # A closed page leaves no work behind
        text = json.dumps(long)
        with socket.create_connection(("127.0.0.1", served.port)) as link:
            link.sendall(f"POST /draw HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\nX-Token: {served.token}\r\nContent-Length: {len(text)}\r\n\r\n{text}".encode())
            time.sleep(0.3)
        for _ in range(40):  # a loaded machine ends it late; the whole reference takes many minutes
            busy = cpu_seconds(served.process.pid)
            time.sleep(0.5)
            if cpu_seconds(served.process.pid) - busy < 0.1:
                break
        else:
            raise Failed("a reference goes on for nobody")
        # Many at once
        several = [threading.Thread(target=lambda: answers.append(served.ask("/draw", wish())[0])) for _ in range(40)]
        for one in several:
            one.start()
        for one in several:
            one.join(timeout=60)
        check(len(answers) == 41 and set(answers) <= {200, 409} and answers.count(200) >= 1, str(answers))
        # Ctrl-C, when the block ends, does not wait for this one
        threading.Thread(target=lambda: served.ask_for_nothing(long), daemon=True).start()
        time.sleep(0.5)
        begin = time.monotonic()
    check(time.monotonic() - begin < 10, "Ctrl-C waited for a reference")


@case("serve.takes_no_request_without_its_token", "input")
def refusals(bench):
    (bench.folder / "models").mkdir()
    (bench.folder / "models/broken.glb").write_bytes(b"glTF, not")
    before = bench.left_behind()
    with Served(bench, "models") as served:
        check(served.ask("/lists")[0] == 200, "the lists")
        page = served.ask(f"/?token={served.token}")
        check(page[0] == 200 and b"<title>burnish" in page[2] and "default-src 'none'" in page[1]["Content-Security-Policy"], "the page")
        for headers in ({"X_Token": ""}, {"X_Token": served.token[:-1]}, {"Host": f"evil.example:{served.port}"}, {"Host": "127.0.0.1"}):
            for path, body in (("/lists", None), ("/draw", wish()), (f"/?token={'0' * 32}", None)):
                check(served.ask(path, body, **headers)[0] == 403, f"{headers} {path}")
        check(served.ask(f"/?token={served.token}", Host="evil.example")[0] == 403, "the page for another host")
        for body, needle in ((b"{", "no JSON"), ([], "no object"), (wish("/etc/passwd"), "scene"), (wish("../models/broken.glb"), "scene"),
                             ({**wish(), "environment": "/etc/passwd"}, "environment"), ({**wish(), "width": 100000}, "width"), ({**wish(), "width": 0}, "width"),
                             ({**wish(), "height": "x"}, "height"), (wish(output="x.png"), "--output"), (wish(stats="x"), "--stats"), (wish(env="x.hdr"), "--env"),
                             (wish(normal_map="x.png"), "--normal-map"), (wish(light="sphere"), "--light"), (wish(nothing="1"), "--nothing"),
                             (wish(roughness="nan"), "--roughness"), (wish(technique="none"), "none"), ({**wish(), "options": {"--roughness": 1}}, "--roughness"),
                             (wish("broken.glb"), "broken.glb"), ({**wish(), "reference_samples": -1}, "reference_samples")):
            status, _, answer = served.ask("/draw", body)
            check(status == 400 and needle in json.loads(answer)["error"], f"{body}: {status} {answer}")
        deep = '{"reference":' + "[" * 400000 + "]" * 400000 + "}"
        for path in ("/draw", "/difference", "/save"):
            check(served.ask(path, deep)[0] == 400, f"{path}: brackets without end")
        check(served.ask("/save", {**wish(), "extension": 1})[0] == 400 and served.ask("/draw", {**wish(), "reduction": 3})[0] == 400, "odd values")
        check(served.ask("/save", wish())[0] == 400 and "-o FOLDER" in json.loads(served.ask("/save", wish())[2])["error"], "save without a folder")
        check(served.ask("/nothing")[0] == 404 and served.ask("/nothing", {})[0] == 404, "a path that is none")
        # Texts that are no HTTP, too long, or cut
        for text in (b"\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/2\r\n\r\n", b"GET / HTTP/1.1\r\n: x\r\n\r\n", b"POST /draw HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n",
                     b"POST /draw HTTP/1.1\r\nContent-Length: -1\r\n\r\n", b"POST /draw HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n",
                     b"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", b"GET / HTTP/1.1\r\nX: " + b"x" * 40000 + b"\r\n\r\n"):
            with socket.create_connection(("127.0.0.1", served.port), timeout=20) as link:
                try:
                    link.sendall(text)
                    answer = link.recv(100)
                except ConnectionError:  # closed before all was sent
                    continue
                check(answer.startswith(b"HTTP/1.1 400"), f"{text[:60]}: {answer}")
        with socket.create_connection(("127.0.0.1", served.port), timeout=20) as link:
            link.sendall(b"POST /draw HTTP/1.1\r\nContent-Length: 100\r\n\r\n{")  # goes without its rest
        check(served.ask("/lists")[0] == 200, "it no longer answers")
    check(bench.left_behind() == before, f"files were written: {bench.left_behind()}")
    (bench.folder / "text.txt").write_text("no scene")
    for words, code, needle in ((("nowhere",), 4, "nowhere"), (("builtin:nope",), 4, "nope"), (("text.txt",), 4, "text.txt"), (("--port", "99999"), 2, "--port"), (("-o", "models/broken.glb"), 7, "broken.glb")):
        bench.run("serve", *words).expect(code).expect_one_line(needle)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        bench.run("serve", "--port", taken.getsockname()[1]).expect(2).expect_one_line("--port")


@case("serve.a_picture_that_nobody_waits_for_stops", budget=20)
def stops(bench):
    """A later picture of the page does not wait for an earlier one, which works on all cores until it stops."""
    with Served(bench, "builtin:teapot") as served:
        served.ask("/draw", wish("builtin:teapot"))  # makes the session
        slow = wish("builtin:teapot", size=(1920, 1080), technique="mc", samples="4096")
        answers = []
        first = threading.Thread(target=lambda: answers.append(served.ask("/draw", slow)[0]))
        first.start()
        time.sleep(0.5)
        status, headers, _ = served.ask("/draw", wish("builtin:teapot"))
        first.join(30)
        check(status == 200 and answers == [409], f"{status} {answers}")
        stages = json.loads(headers["X-Burnish"])["stages"]
        check({"shade", "coverage"} <= {stage["name"] for stage in stages} and all(stage["ms"] > 0 for stage in stages), str(stages))


@case("serve.saves_where_it_may_and_sees_files_change", budget=10)
def saves(bench):
    (bench.folder / "models").mkdir()
    model = bench.folder / "models/lamp.glb"
    shutil.copy(bench.data_file("models/AnisotropyBarnLampSmall.glb"), model)
    with Served(bench, "models", "-o", "pictures", "--watch") as served:
        lists = json.loads(served.ask("/lists")[2])
        check(lists["scenes"][0] == "lamp.glb" and "builtin:sphere" in lists["scenes"] and lists["save"] and lists["watch"], str(lists)[:300])
        check({"--roughness", "--technique", "--env-rotation"} <= {row["name"] for row in lists["options"]}, "options")
        status, _, answer = served.ask("/save", wish("lamp.glb"))
        check(status == 200, str(answer))
        served.ask("/save", {**wish("lamp.glb"), "extension": ".exr"})
        served.ask("/save", wish("lamp.glb"))
        check(served.ask("/save", {**wish(), "extension": "/../x.png"})[0] == 400, "a name that leads elsewhere")
        check(sorted(os.listdir(bench.folder / "pictures")) == ["picture-0001.exr", "picture-0001.png", "picture-0002.png"], str(bench.left_behind()))
        both = {"reference": wish("lamp.glb"), "test": wish("lamp.glb", roughness="0.9")}
        check(json.loads(served.ask("/save", {**both, "extension": ".png"})[2])["path"].endswith("picture-0003.png"), "an error map")
        check((bench.folder / "pictures/picture-0003.png").read_bytes() == served.ask("/difference", both)[2], "another error map")
        check(served.ask("/save", {**wish("lamp.glb"), "reference_samples": 64})[0] in (200, 400), "a reference")  # 400: without Embree
        check(json.loads(served.ask("/changes")[2])["changes"] == 0, "nothing has changed")
        before = json.loads(served.ask("/draw", wish("lamp.glb"))[1]["X-Burnish"])["hash"]
        whole = bench.data_file("models/AnisotropyBarnLampSmall.glb").read_bytes()
        changes = lambda: json.loads(served.ask("/changes")[2])["changes"]
        model.write_bytes(whole[:1000])  # half of another version, then all of it
        os.utime(model, (1, 1))
        check(changes() == 1 and served.ask("/draw", wish("lamp.glb"))[0] == 400, "a changed file was not seen")
        shutil.copy(bench.data_file("models/Lights.glb"), model)
        os.utime(model, (2, 2))
        check(changes() == 2, "a file that was mended was not seen")
        listed = lambda: json.loads(served.ask("/changes")[2])["lists"]
        check(listed() == 0, "a list that is as it was")
        shutil.copy(model, bench.folder / "models/another.glb")
        check(listed() == 1 and listed() == 1, "a new model was not seen")
        bench.run("render", "builtin:plate", "--size", "32x16", "-q", "-o", "models/sky.pfm").expect(0)
        check(listed() == 2 and "sky.pfm" in json.loads(served.ask("/lists")[2])["environments"], "a new environment was not seen")
        secret = {"light": "sphere:points=0,1,0:radius=0.1:radiance=9,9,9:texture=/etc/passwd"}
        two = {"light": "sphere:points=0,1,0:radius=0.1:radiance=9,9,9;sphere:points=1,1,0:radius=0.1:radiance=0,9,0"}
        drawn = json.loads(served.ask("/draw", wish("lamp.glb", **two))[1]["X-Burnish"])
        check(drawn["command"].count("--light") == 2, f"not two lights: {drawn}")
        check(drawn["hash"] == hash_of_command(bench, drawn["command"]), f"two lights draw another picture than their command: {drawn}")
        spaced = json.loads(served.ask("/draw", wish("lamp.glb", light=" " + two["light"].replace(";", " ;; ") + "; "))[1]["X-Burnish"])
        check((spaced["command"], spaced["hash"]) == (drawn["command"], drawn["hash"]), f"blanks and empty lights count: {spaced}")
        status, _, answer = served.ask("/draw", wish("lamp.glb", **secret))
        check(status == 400 and b"names a file" in answer, f"a page names a file: {answer}")
        check(json.loads(served.ask("/lists")[2])["scenes"][:2] == ["another.glb", "lamp.glb"], "the new model is not listed")
        check(served.ask("/draw", wish("another.glb"))[0] == 200, "the new model is not drawn")
        check(json.loads(served.ask("/draw", wish("lamp.glb"))[1]["X-Burnish"])["hash"] != before, "another file, the same picture")


@case("serve.page_turns_compares_and_shows_its_command", budget=25)
def page(bench):
    """A browser draws every step of the page."""
    with Served(bench, "builtin:sphere", "-o", "pictures") as served, Browser(bench.folder / "browser") as browser:
        browser.size(900, 600)
        browser.visit(served.address)
        done = lambda mode: browser.until(f"document.body.dataset.done === '{mode}'", 60)
        done("A")
        browser.value("(() => { Object.assign(state.options.A, " + json.dumps(SMALL_LIGHT) + "); later(); document.body.dataset.done = ''; })()")
        done("A")
        first = browser.value("document.body.dataset.hash")
        check(first == hash_of_command(bench, browser.value("document.getElementById('command').textContent")), "the page's hash is not the command's")
        # An option by its row, then a turn by the mouse
        browser.value("""(() => { const input = document.getElementById('o--roughness'); input.value = '0.3';
            document.body.dataset.done = ''; input.dispatchEvent(new Event('change')); })()""")
        done("A")
        second = browser.value("document.body.dataset.hash")
        check(second != first and "--roughness 0.3" in browser.value("document.getElementById('command').textContent"), "the option does nothing")
        browser.value("document.body.dataset.done = ''")
        browser.mouse("mousePressed", 200, 300, button="left", clickCount=1)
        browser.mouse("mouseMoved", 260, 320, button="left", buttons=1)
        browser.mouse("mouseReleased", 260, 320, button="left", clickCount=1)
        done("A")
        command = browser.value("document.getElementById('command').textContent")
        check("--eye" in command and browser.value("document.body.dataset.hash") == hash_of_command(bench, command), command)
        # A move keeps the distance
        place = lambda name: [float(x) for x in browser.value("document.getElementById('command').textContent").split(f"--{name} ")[1].split()[0].split(",")]
        before = place("eye"), place("target")
        browser.value("(() => { document.body.dataset.done = ''; document.getElementById('view').focus(); document.getElementById('view').dispatchEvent("
                      "new KeyboardEvent('keydown', { key: 'ArrowRight', shiftKey: true })); })()")
        done("A")
        moved = [b - a for a, b in zip(before[0], place("eye"))]
        check(all(abs((b - a) - m) < 1e-6 for a, b, m in zip(before[1], place("target"), moved)) and max(map(abs, moved)) > 1e-3, f"{before} {moved}")
        # B with another technique beside A, their difference, the reference
        browser.value("(() => { document.getElementById('copy').click(); state.options.B['--technique'] = 'bent_normal'; })()")
        for mode in ("split", "error"):
            browser.value(f"(() => {{ document.body.dataset.done = ''; document.querySelector('[data-show={mode}]').click(); }})()")
            done(mode)
            if mode == "split":  # the line moves by keys, too
                browser.value("document.getElementById('line').focus()")
                browser.press("ArrowRight")
                line = browser.value("[document.getElementById('line').getAttribute('aria-valuenow'), document.getElementById('view').style.getPropertyValue('--split')]")
                check(line == ["52", "52%"], str(line))
            browser.screenshot(bench.folder / f"{mode}.png")
            # Read the figures of one picture at once: a delayed frame may begin another picture
            read = f"document.body.dataset.done === '{mode}' && [shown.a.hash, shown.b.hash, ...['command', 'command_b'].map(id => document.getElementById(id).textContent)]"
            browser.until(read, 60)
            seen = browser.value(read)
            while not seen:
                browser.until(read, 60)
                seen = browser.value(read)
            for side, drawn_hash, command in zip("ab", seen[:2], seen[2:]):
                check(("bent_normal" in command) == (side == "b"), command)
                expected = hash_of_command(bench, command)
                check(drawn_hash == expected, f"side {side}: the page shows {drawn_hash}, its command draws {expected}: {command}")
            # A page at rest draws nothing, whatever its size
            for width, height in ((1000, 700), (1280, 720)):
                browser.size(width, height)
                time.sleep(0.3)
                done(mode)
                drawn = browser.value("generation")
                time.sleep(0.6)
                check(browser.value("generation") == drawn, f"{mode} at {width}x{height}: the page goes on drawing")
        check("mean 0." in browser.value("document.getElementById('figures').textContent"), "no figure of the difference")
        browser.value("document.querySelector('[data-show=reference]').click()")
        browser.until("document.body.dataset.samples >= 256", 60)  # it goes on
        browser.screenshot(bench.folder / "reference.png")
        browser.value("(() => { document.body.dataset.done = ''; document.querySelector('[data-show=A]').click(); })()")
        done("A")
        browser.value("document.querySelector('[data-save]').click()")
        browser.until("document.getElementById('note').textContent.includes('picture-0001.png')")
        check((bench.folder / "pictures/picture-0001.png").exists(), "nothing was saved")
        browser.size(400, 800)
        browser.value("document.body.dataset.done = ''")
        done("A")
        check(browser.value("document.documentElement.scrollWidth <= 400"), "the page is wider than a phone")
        browser.screenshot(bench.folder / "narrow.png")
        check(not browser.faults, f"the console says {browser.faults}")
        outside = [url for url in browser.requests if not url.startswith((f"http://127.0.0.1:{served.port}/", "blob:", "data:", "about:"))]
        check(not outside, f"it asks {outside}")


@case("serve.page_shows_every_error_and_no_other_scene", budget=15)
def errors(bench):
    """A browser draws every step of the page."""
    (bench.folder / "models").mkdir()
    (bench.folder / "models/broken.glb").write_bytes(b"glTF, not")
    lights = ";".join(["sphere:points=0,1,0:radius=0.1:radiance=9,9,9"] * 6)
    seen = ("""(() => { const box = document.getElementById('message').getBoundingClientRect(), foot = document.querySelector('footer').getBoundingClientRect();
        const inside = box.height > 10 && box.top >= 0 && box.left >= 0 && box.bottom <= innerHeight && box.right <= innerWidth;
        return inside && (innerWidth < 700 || (box.top >= foot.top && box.bottom <= foot.bottom)); })()""")
    text = lambda browser, name: browser.value(f"document.getElementById('{name}').textContent")
    with Served(bench, "models") as served, Browser(bench.folder / "browser") as browser:

        def draw(change, mode):
            browser.value(f"(() => {{ {change}; document.body.dataset.done = ''; later(); }})()")
            browser.until(f"document.body.dataset.done === '{mode}'", 60)

        browser.size(1280, 800)
        browser.visit(served.address)
        browser.until("lists !== null && document.body.dataset.done === 'fault'", 60)  # the broken file comes first
        check("broken.glb" in text(browser, "message") and browser.value(seen), "the first error is not seen")
        check(text(browser, "command") == text(browser, "figures") == "", "a command without a picture")
        # An unset slider stands at its default, or has no thumb
        ranges = dict(browser.value("[...document.querySelectorAll('input[type=range]')].map(one => [one.closest('.row').dataset.name, [one.className, +one.value, one.max]])"))
        check(ranges["--env-exposure"][:2] == ["", 0], ranges)
        check(ranges["--samples"][0] == ranges["--roughness"][0] == ranges["--anisotropy"][0] == "unknown", ranges)
        for width, height in ((1280, 800), (400, 800), (400, 500)):
            browser.size(width, height)
            draw("state.scene = 'builtin:sphere'; make_lists(); Object.assign(state.options.A, " + json.dumps({**SMALL_LIGHT, "--light": lights}) + "); show('A')", "A")
            draw("state.options.B = { ...state.options.A, '--technique': 'bent_normal' }; show('split')", "split")
            check(browser.value("['command', 'command_b'].every(id => { const code = document.getElementById(id), box = code.getBoundingClientRect(); "
                                "return box.height > 30 && (code.scrollHeight <= code.clientHeight || getComputedStyle(code).overflowY === 'auto'); })"), "a command is cut")
            draw("state.options.A['--roughness'] = 'nan'; show('A')", "fault")
            check("--roughness" in text(browser, "message") and browser.value(seen), f"the error is out of sight at {width}x{height}")
            check(browser.value("document.getElementById('a').hasAttribute('src')"), "the picture of this scene is gone")
            browser.screenshot(bench.folder / f"fault_{width}_{height}.png", whole=False)
            # Nothing of this scene stays under another name
            draw("delete state.options.A['--roughness']; show('split')", "split")
            draw("const list = document.getElementById('scene'); list.value = 'broken.glb'; list.dispatchEvent(new Event('change'))", "fault")
            check("broken.glb" in text(browser, "message") and browser.value(seen), f"the file's error is out of sight at {width}x{height}")
            check(not browser.value("['a', 'b', 'e'].some(id => document.getElementById(id).hasAttribute('src'))"), "another scene's picture stays")
            check(text(browser, "command") == text(browser, "command_b") == text(browser, "figures") == "", "another scene's command stays")
        check(browser.value("document.documentElement.scrollWidth <= 400"), "the page is wider than a phone")


@case("serve.every_option_draws_what_its_command_draws", tier="nightly")
def every_option(bench):
    """A kept session must not outlive an option that it depends on."""
    values = {"--camera": [], "--variant": [], "--orbit": ["30,10"], "--eye": ["0.6,0.3,0.6"], "--target": ["0,0.05,0"], "--f0": ["0.9,0.5,0.3"], "--tilt": ["10,0"], "--env-size": ["32"],
              "--env-samples": ["32"], "--light": ["sphere:points=0,1,0:radius=0.1:radiance=9,9,9"], "--samples": ["9"], "--shadow-samples": ["32"], "--msaa": ["8"]}
    for scene in ("builtin:bumps", "builtin:lights"):
        with Served(bench, scene) as served:
            wrong, seen = [], 0
            for row in json.loads(served.ask("/lists")[2])["options"]:
                usual = row["initial"]
                tried = values.get(row["name"]) if row["name"] in values else [""] if row["kind"] == "flag" else [
                    name for name in row["names"] if name != usual][:3] if row["names"] else [str(row["low"] + (min(row["high"], row["low"] + 2) - row["low"]) // 2)]
                for value in tried or []:
                    request = wish(scene, size=(32, 24))
                    request["options"][row["name"]] = value
                    status, headers, answer = served.ask("/draw", request)
                    if status != 200:
                        continue  # refused, as the program would
                    info, seen = json.loads(headers["X-Burnish"]), seen + 1
                    if info["hash"] != hash_of_command(bench, info["command"]):
                        wrong.append(f"{row['name']} {value}")
            check(not wrong and seen > 60, f"{scene}, {seen} pictures: {wrong}")
