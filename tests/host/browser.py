"""A real browser without a window: opens pages from files, measures and photographs them. Debian's
chromium-headless-shell, spoken to in its DevTools protocol through a pipe; no network is used."""

import base64
import json
import os
import pathlib
import shutil
import subprocess
import tempfile


class Browser:
    """Use it in a `with`."""

    def __enter__(self):
        program = shutil.which("chromium-headless-shell") or shutil.which("chromium")
        assert program, "no browser: scripts/setup.sh installs chromium-headless-shell"
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        reading, self._writing = os.pipe()
        self._answers, writing = os.pipe()
        # The browser reads from file descriptor 3 and writes to 4.
        self._process = subprocess.Popen(
            ["bash", "-c", f'exec "$0" "$@" 3<&{reading} 4>&{writing}', program, "--headless", "--no-sandbox",
             "--disable-gpu", "--remote-debugging-pipe", f"--user-data-dir={self._folder.name}", "about:blank"],
            pass_fds=(reading, writing), stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(reading)
        os.close(writing)
        self._count, self._rest, self._session = 0, b"", None
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self._call("Page.enable")
        return self

    def __exit__(self, *_):
        self._session = None
        self._call("Browser.close")
        self._process.wait()
        os.close(self._writing)
        os.close(self._answers)
        self._folder.cleanup()

    def open(self, path, width, height=844):
        """Shows the file in a window of this size, in CSS pixels, as a phone or a screen of that width would."""
        self._call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600
        )
        self._call("Page.navigate", url=pathlib.Path(path).resolve().as_uri())
        self._await("Page.loadEventFired")

    def value(self, expression):
        """The value of a JavaScript expression in the page; it may be a promise."""
        done = self._call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in done, done["exceptionDetails"]
        return done["result"].get("value")

    def screenshot(self, path, whole=False):
        """PNG of the window or of the whole page."""
        self.value("Promise.all([...document.images].map(i => (i.loading = 'eager', i.decode())))")
        data = self._call("Page.captureScreenshot", captureBeyondViewport=whole)["data"]
        pathlib.Path(path).write_bytes(base64.b64decode(data))

    def _call(self, method, **parameters):
        self._count += 1
        message = {"id": self._count, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._writing, json.dumps(message).encode() + b"\0")
        answer = self._until(lambda m: m.get("id") == self._count)
        assert "error" not in answer, answer["error"]
        return answer["result"]

    def _await(self, event):
        self._until(lambda m: m.get("method") == event)

    def _until(self, wanted):
        while True:
            while b"\0" not in self._rest:
                data = os.read(self._answers, 1 << 20)
                assert data, "the browser ended"
                self._rest += data
            message, self._rest = self._rest.split(b"\0", 1)
            message = json.loads(message)
            if wanted(message):
                return message
