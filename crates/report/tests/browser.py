#!/usr/bin/env python3
"""Opens pages in headless Chromium: `browser.py PAGE [--shots FOLDER] [--fps] [--width 1280] [--dark]`.

Needs Chromium (Debian: apt-get install chromium) and Python alone: it speaks the DevTools protocol over a pipe. Checks that the page
draws itself without an error, that nothing is fetched, that moving the slider changes the picture, and that nothing of a run is read
as HTML. Says how long the page took to open and, with --fps, how fast it plays. Exit code 1 when a check fails.
"""
import argparse
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
from pathlib import Path


class Browser:
    """Headless Chromium with one page."""

    def __init__(self, program, width, height, dark):
        self.profile = tempfile.mkdtemp(prefix="granular-report-")
        to_browser, self.write_end = os.pipe()
        self.read_end, from_browser = os.pipe()

        def connect():
            # The pipe of the protocol: the browser reads from 3 and writes to 4.
            os.dup2(to_browser, 103)
            os.dup2(from_browser, 104)
            os.dup2(103, 3)
            os.dup2(104, 4)

        flags = ["--headless=new", "--no-sandbox", "--remote-debugging-pipe", "--enable-unsafe-swiftshader", "--use-angle=swiftshader",
                 "--hide-scrollbars", "--no-first-run", f"--user-data-dir={self.profile}", f"--window-size={width},{height}", "about:blank"]
        self.process = subprocess.Popen([program, *flags], preexec_fn=connect, close_fds=False, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.buffer, self.number, self.events = b"", 0, []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self.call(f"{domain}.enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 700)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    session = None

    def message(self, seconds=120):
        end = time.monotonic() + seconds
        while b"\0" not in self.buffer:
            if not select.select([self.read_end], [], [], max(0, end - time.monotonic()))[0]:
                raise TimeoutError("the browser does not answer")
            piece = os.read(self.read_end, 1 << 20)
            if not piece:
                raise EOFError("the browser has ended")
            self.buffer += piece
        text, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, **parameters):
        self.number += 1
        call = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            call["sessionId"] = self.session
        text = json.dumps(call).encode() + b"\0"
        while text:
            text = text[os.write(self.write_end, text):]
        while True:
            message = self.message()
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]
            self.events.append(message)

    def open(self, page):
        """Opens a page; seconds until it has drawn itself."""
        begun = time.monotonic()
        self.call("Page.navigate", url=Path(page).resolve().as_uri())
        while self.value("document.documentElement?.dataset.ready || ''") != "yes":
            if time.monotonic() - begun > 60:
                raise TimeoutError(f"{page} is not ready: {self.problems()}")
            time.sleep(0.02)
        # Two frames later all is on the screen.
        self.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")
        return time.monotonic() - begun

    def value(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def problems(self):
        """Errors and warnings of the page, and what it fetched."""
        found = []
        for event in self.events:
            method, about = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                found.append(json.dumps(about["exceptionDetails"])[:1500])
            elif method == "Runtime.consoleAPICalled" and about["type"] in ("error", "warning", "assert"):
                found.append(json.dumps(about["args"])[:800])
            elif method == "Log.entryAdded" and about["entry"]["level"] in ("error", "warning"):
                found.append(about["entry"]["text"])
            elif method == "Network.requestWillBeSent" and not about["request"]["url"].startswith(("file:", "data:", "about:", "blob:")):
                found.append(f"fetched {about['request']['url']}")
        return [text for text in found if "GPU stall due to ReadPixels" not in text]

    def shot(self, clip=None):
        options = {"clip": {**clip, "scale": 1}, "captureBeyondViewport": True} if clip else {}
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", **options)["data"])

    def box(self, selector):
        return self.value(f"""(() => {{ const box = document.querySelector({json.dumps(selector)})?.getBoundingClientRect();
            return box && {{ x: box.x + scrollX, y: box.y + scrollY, width: box.width, height: box.height }}; }})()""")

    def close(self):
        self.process.terminate()
        self.process.wait(10)
        shutil.rmtree(self.profile, ignore_errors=True)


def pixels(png):
    """Bytes of the rows of a PNG of 8 bits a colour."""
    at, data, width, channels = 8, b"", 0, 0
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        body = png[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, _, _, colour = struct.unpack(">IIBB", body[:10])
            channels = {2: 3, 6: 4}[colour]
        elif kind == b"IDAT":
            data += body
        at += 12 + length
    raw, stride, rows = zlib.decompress(data), width * channels, []
    for start in range(0, len(raw), stride + 1):
        rows.append(unfiltered(raw[start], bytearray(raw[start + 1:start + 1 + stride]), rows[-1] if rows else bytes(stride), channels))
    return rows


def unfiltered(kind, row, above, channels):
    """A row of a PNG without its filter."""
    for k in range(len(row)):
        left = row[k - channels] if k >= channels else 0
        corner = above[k - channels] if k >= channels else 0
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = above[k]
        elif kind == 3:
            guess = (left + above[k]) // 2
        elif kind == 4:
            base = left + above[k] - corner
            guess = min((left, above[k], corner), key=lambda value: abs(base - value))
        else:
            guess = 0
        row[k] = (row[k] + guess) & 255
    return row


def changed(first, second):
    """Share of the bytes of two pictures that differ."""
    pairs = zip(pixels(first), pixels(second))
    counts = [(sum(a != b for a, b in zip(one, other)), len(one)) for one, other in pairs]
    return sum(count for count, _ in counts) / max(1, sum(length for _, length in counts))


def moved(browser, failures):
    """Whether the picture changes with the slider."""
    box = browser.box(".stage")
    if not box:
        return
    go = "(() => {{ const slider = document.querySelector('.player input'); slider.value = {0}; slider.dispatchEvent(new Event('input')); return slider.max; }})()"
    last = int(browser.value(go.format(0)))
    first = browser.shot(box)
    browser.value(go.format(last))
    second = browser.shot(box)
    share = changed(first, second)
    print(f"  slider from 0 to {last}: {100 * share:.2f} % of the picture changes")
    if last > 0 and share < 0.0005:
        failures.append("the slider changes nothing")


def hovered(browser, failures):
    """Whether a chart tells values below the pointer."""
    box = browser.box(".plot canvas")
    if not box:
        return
    browser.value(f"scrollTo(0, {box['y'] - 100})")
    for x in [box["width"] * 0.5, box["width"] * 0.52]:
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=box["x"] + x, y=100 + box["height"] * 0.4)
    text = browser.value("document.querySelector('.plot .readout:not([hidden])')?.textContent || ''")
    print(f"  read-out: {text[:90]}")
    if not text:
        failures.append("a chart tells no value below the pointer")


def zoomed(browser, failures):
    """Whether dragging over a chart shows a part."""
    box = browser.box(".plot canvas")
    if not box:
        return
    browser.value(f"scrollTo(0, {box['y'] - 100})")
    at = lambda kind, share: browser.call("Input.dispatchMouseEvent", type=kind, x=box["x"] + share * box["width"], y=200, button="left", clickCount=1)
    at("mousePressed", 0.4)
    at("mouseMoved", 0.5)
    at("mouseMoved", 0.6)
    at("mouseReleased", 0.6)
    if browser.value("document.querySelector('.plot .reset').hidden"):
        failures.append("dragging over a chart does not zoom")
    browser.value("document.querySelector('.plot .reset').click()")


def frames_per_second(browser, seconds=6):
    return browser.value(f"""new Promise((done) => {{ const player = granularReport.player; player.speed = 1000; player.play();
        const from = player.frames, begun = performance.now();
        const next = () => {{ if (!player.timer) player.play();
            const passed = performance.now() - begun;
            if (passed < {1000 * seconds}) return setTimeout(next, 20);
            player.pause(); return done((player.frames - from) / passed * 1000); }}; next(); }})""")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", nargs="+")
    parser.add_argument("--shots", help="folder for pictures")
    parser.add_argument("--fps", action="store_true")
    parser.add_argument("--width", type=int, default=1280)
    parser.add_argument("--dark", action="store_true")
    parser.add_argument("--chromium", default=shutil.which("chromium") or shutil.which("chromium-browser"))
    options = parser.parse_args()
    failures = []
    browser = Browser(options.chromium, options.width, 800, options.dark)
    try:
        for page in options.page:
            browser.events.clear()
            seconds = browser.open(page)
            print(f"{page}: {os.path.getsize(page) / 1e6:.1f} MB, ready after {seconds:.2f} s")
            own = []
            moved(browser, own)
            hovered(browser, own)
            zoomed(browser, own)
            if browser.value("window.hostile !== undefined || document.querySelectorAll('#main script, #main iframe, #main [onerror]').length > 0"):
                own.append("something of a run was read as HTML")
            wide = browser.value("document.documentElement.scrollWidth - innerWidth")
            if wide > 0:
                own.append(f"the page is {wide} pixels wider than the window")
            if options.fps:
                print(f"  plays {frames_per_second(browser):.1f} frames a second")
            own += browser.problems()
            failures += [f"{page}: {text}" for text in own]
            if options.shots:
                Path(options.shots).mkdir(parents=True, exist_ok=True)
                look = f"{options.width}{'-dark' if options.dark else ''}"
                browser.value("scrollTo(0, 0)")
                height = browser.value("document.documentElement.scrollHeight")
                picture = browser.shot({"x": 0, "y": 0, "width": options.width, "height": height})
                (Path(options.shots) / f"{Path(page).stem}-{look}.png").write_bytes(picture)
    finally:
        browser.close()
    print("\n".join(failures) if failures else "all checks passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
