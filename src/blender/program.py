# SPDX-License-Identifier: GPL-3.0-or-later
"""The program as a process: its arguments, its events in JSON lines, its end."""

import json
import os
import queue
import shutil
import signal
import subprocess
import threading
import time

STAGES = ("loading", "choosing", "rays", "sampling", "irradiance", "random walks", "diffusion", "bounces", "shading",
          "light groups", "mattes", "writing")
PRESETS = ("apple", "chicken1", "chicken2", "cream", "ketchup", "marble", "potato", "skimmilk", "skin1", "skin2",
           "spectralon", "wholemilk", "alabaster", "candle", "grape", "honey", "jade", "leaf", "milk_glass", "salmon",
           "skin_dark", "skin_fair", "snow", "soap", "wax")
POLL_SECONDS = 0.05
PATIENCE_SECONDS = 5  # between the request to stop and the kill
STDERR_LINES = 5


class ProgramError(RuntimeError):
    """The program is missing or reports an error."""


class Cancelled(Exception):
    """The user cancelled the render."""


def find_program(preferred=""):
    """Path of the program: the preferred one, or the one on PATH. Raises ProgramError without one."""
    path = shutil.which(os.path.expanduser(preferred)) if preferred else shutil.which("opaline")
    if path is None:
        asked = f"'{preferred}' is no program" if preferred else "no program 'opaline' on PATH"
        raise ProgramError(f"{asked}; set its path in the preferences of the add-on")
    return path


def start(words):
    """Starts the program with its events on stdout."""
    try:
        return subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                text=True, encoding="utf-8", errors="replace")
    except OSError as error:
        raise ProgramError(f"{words[0]}: {error.strerror}") from error


def stop(process):
    """Asks the program to stop, and kills it after a while. An interrupted program leaves no partial file."""
    if process.poll() is None:
        process.terminate() if os.name == "nt" else process.send_signal(signal.SIGINT)
        try:
            process.wait(PATIENCE_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
    for stream in (process.stdout, process.stderr):
        stream.close()


def event_of(line):
    """A line as an event, or None."""
    try:
        event = json.loads(line)
    except ValueError:
        return None
    return event if isinstance(event, dict) and "event" in event else None


class Reader:
    """Reads both streams of a process in threads."""

    def __init__(self, process):
        self.events = queue.Queue()
        self.errors = []
        self.threads = [threading.Thread(target=self.read_events, args=(process.stdout,), daemon=True),
                        threading.Thread(target=self.read_errors, args=(process.stderr,), daemon=True)]
        for thread in self.threads:
            thread.start()

    def read_events(self, stream):
        try:
            for line in stream:
                event = event_of(line)
                if event is not None:
                    self.events.put(event)
        except ValueError:
            pass  # closed by stop
        self.events.put(None)

    def read_errors(self, stream):
        try:
            for line in stream:
                self.errors = [*self.errors[1 - STDERR_LINES:], line.strip()]
        except ValueError:
            pass

    def next_event(self, seconds):
        """The next event; None at the end. Raises queue.Empty without one in this time."""
        return self.events.get(timeout=seconds)


def fraction_done(event, last):
    """Fraction of the whole run after a progress event; never decreases."""
    stage = event.get("stage", "")
    number = STAGES.index(stage) if stage in STAGES else -1
    return max(last, (number + event.get("fraction", 0.0)) / len(STAGES)) if number >= 0 else last


def status_text(event):
    """The current stage in words."""
    text = event.get("stage", "")
    if "fraction" in event:
        text += f" {100 * event['fraction']:.0f} %"
    if "seconds_left" in event:
        text += f", {event['seconds_left']:.0f} s left"
    return text


def run(words, is_cancelled, on_progress, on_warning):
    """Runs the program to its end and returns its event "done".

    on_progress: called with a fraction and a text. Raises Cancelled, or ProgramError with the program's message.
    """
    process = start(words)
    reader = Reader(process)
    done, failure, fraction = None, None, 0.0
    try:
        while True:
            if is_cancelled():
                raise Cancelled
            try:
                event = reader.next_event(POLL_SECONDS)
            except queue.Empty:
                continue
            if event is None:
                break
            if event["event"] == "progress":
                fraction = fraction_done(event, fraction)
                on_progress(fraction, status_text(event))
            elif event["event"] == "warning":
                on_warning(event.get("message", event.get("text", "")))
            elif event["event"] == "error":
                failure = event.get("message", "")
            elif event["event"] == "done":
                done = event
        while process.poll() is None:
            if is_cancelled():
                raise Cancelled
            time.sleep(POLL_SECONDS)
    finally:
        stop(process)
    if failure is not None or process.returncode != 0 or done is None:
        raise ProgramError(failure or " ".join(reader.errors) or f"the program ended with {process.returncode}")
    return done


def presets(path):
    """Names of the presets, from the program's JSON Schema."""
    try:
        text = subprocess.run([path, "schema"], capture_output=True, text=True, check=True, timeout=10).stdout
        choices = json.loads(text)["definitions"]["medium"]["properties"]["preset"]["anyOf"]
        return tuple(next(choice["enum"] for choice in choices if "enum" in choice))
    except (OSError, ValueError, KeyError, StopIteration, subprocess.SubprocessError):
        return PRESETS
