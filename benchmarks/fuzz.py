"""Every reader of something from outside, fed with spoiled input until 10 million bytes or the time are through.

A find is an exception that is no refusal in words, an input that takes more than 5 s of the processor or a minute by
the clock, or more than 1 GB of memory.
Each target runs in a process of its own. The engine is atheris (coverage-guided, the benchmark extra) where it is
installed, else a seeded mutational fuzzer of ours with the same targets and seeds; ``--engine plain`` takes that one.

    python3 run.py bench fuzz [TARGET...] [--seconds 60] [--bytes 10000000] [--engine plain] [--seed 1]
    python3 run.py bench fuzz --hour                 an hour in all, shared between the targets
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Sequence
from pathlib import Path
from types import FrameType
from typing import Any

MOST_MEMORY = 1 << 30
ADDRESS_SPACE = 6 << 30  # numpy and Qt reserve much that they never touch
SLOWEST_S = 5.0  # of the processor: a busy machine makes no find
STUCK_S = 60  # by the clock
GRACE_S = 120  # to start, and to instrument
NAMES = Path(__file__).resolve().parent


class Budget:
    """How much was fed, how long it took, and when it is enough."""

    def __init__(self, most_bytes: int, seconds: float) -> None:
        self.inputs = self.bytes = 0
        self.slowest_ms = 0.0
        self._most_bytes, self._started, self._seconds = most_bytes, time.perf_counter(), seconds

    @property
    def spent(self) -> bool:
        return self.bytes >= self._most_bytes or time.perf_counter() - self._started > self._seconds

    def count(self, data: bytes, seconds: float) -> None:
        """One input was read."""
        self.inputs += 1
        self.bytes += len(data)
        self.slowest_ms = max(self.slowest_ms, 1e3 * seconds)

    def figures(self) -> dict[str, Any]:
        """For the line."""
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        seconds = round(time.perf_counter() - self._started, 1)
        return {
            "inputs": self.inputs,
            "bytes": self.bytes,
            "seconds": seconds,
            "slowest_ms": round(self.slowest_ms, 1),
            "peak_mb": round(peak / 1e6),
        }


def one_input(run: Any, data: bytes, budget: Budget) -> str:
    """Read one input; the find as text, "" when there is none."""
    started = time.perf_counter()
    signal.setitimer(signal.ITIMER_PROF, SLOWEST_S)
    signal.alarm(STUCK_S)
    try:
        run(data)
    except BaseException:
        return traceback.format_exc(limit=-6)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.alarm(0)
        budget.count(data, time.perf_counter() - started)
    if resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 > MOST_MEMORY:
        return f"more than {MOST_MEMORY >> 20} MB of memory"
    return ""


def too_slow(_: int, __: FrameType | None) -> None:
    raise TimeoutError(f"an input took more than {SLOWEST_S:g} s of the processor, or {STUCK_S} s in all")


def plain(target: Any, budget: Budget, seed: int) -> tuple[str, bytes]:
    """The mutational engine: (find, its input)."""
    from _fuzz_mutate import mutate

    chance = random.Random(seed)  # noqa: S311 (a fuzzer, no secret)
    pool = list(target.seeds())
    for data in pool:
        if find := one_input(target.run, data, budget):
            return find, data
    while not budget.spent:
        data = mutate(chance.choice(pool), chance.getrandbits(60), chance.choice(pool))
        if find := one_input(target.run, data, budget):
            return find, data
        if chance.random() < 0.02:  # what was spoiled is spoiled further
            pool[len(pool) - 1 if len(pool) > 60 else len(pool) :] = [data]
    return "", b""


def guided(target: Any, budget: Budget, seed: int) -> tuple[str, bytes]:
    """The engine of atheris; it leaves the process itself when the budget is spent, through ``finish``."""
    import atheris
    from _fuzz_mutate import mutate

    corpus = Path(tempfile.mkdtemp(prefix="imugui-corpus-"))
    pool = list(target.seeds())
    for number, data in enumerate(pool):
        (corpus / str(number)).write_bytes(data)

    def custom(data: bytes, most: int, number: int) -> bytes:
        return atheris.Mutate(data, most) if number % 2 else mutate(data, number, pool[number % len(pool)])[:most]

    def test_one(data: bytes) -> None:
        find = one_input(target.run, data, budget)
        if find or budget.spent:
            shutil.rmtree(corpus, ignore_errors=True)
            finish(budget, find, data)

    arguments = [sys.argv[0], str(corpus), f"-seed={seed}", "-max_len=20000", "-rss_limit_mb=0", "-verbosity=0"]
    atheris.Setup(arguments, test_one, custom_mutator=custom)
    atheris.Fuzz()
    return "", b""


def finish(budget: Budget, find: str, data: bytes) -> None:
    """Tell the parent and end this process."""
    import _fuzz_targets

    shutil.rmtree(_fuzz_targets.home(), ignore_errors=True)
    print(json.dumps({**budget.figures(), "find": find, "input": data.hex() if find else ""}), flush=True)
    os._exit(0)


def child(name: str, engine: str, most_bytes: int, seconds: float, seed: int) -> None:
    """Fuzz one target in this process."""
    warnings.simplefilter("error")
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    for late in (signal.SIGPROF, signal.SIGALRM):
        signal.signal(late, too_slow)
    if engine == "atheris":
        import atheris

        with atheris.instrument_imports(include=["imugui", "json", "csv"]):
            import _fuzz_targets
    else:
        import _fuzz_targets
    target = _fuzz_targets.TARGETS[name]
    target.seeds()
    budget = Budget(most_bytes, seconds)
    finish(budget, *(guided if engine == "atheris" else plain)(target, budget, seed))


def fuzz(name: str, engine: str, most_bytes: int, seconds: float, seed: int) -> dict[str, Any]:
    """Fuzz one target in a process of its own; what came out."""
    arguments = ["--child", "--engine", engine, "--bytes", str(most_bytes), "--seconds", str(seconds)]
    command = [sys.executable, __file__, name, *arguments, "--seed", str(seed)]
    environ = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=seconds + GRACE_S, env=environ, cwd=NAMES, check=False
        )
    except subprocess.TimeoutExpired:
        return {"find": "it hangs: not even the alarm came through"}
    with contextlib.suppress(ValueError, IndexError):
        said = json.loads(done.stdout.splitlines()[-1])
        if isinstance(said, dict):
            return said
    return {"find": f"the process ended with {done.returncode}: {done.stderr[-800:]}"}


def keep(name: str, found: dict[str, Any], folder: Path) -> str:
    """Put the input of a find into a file; its path."""
    path = folder / f"{name}.find"
    path.write_bytes(bytes.fromhex(found.get("input", "")))
    return str(path)


def targets() -> list[str]:
    """Every target's name, without the imports of this process being instrumented or not."""
    import _fuzz_targets

    return list(_fuzz_targets.TARGETS)


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("targets", nargs="*", help="all of them when none is named")
    parser.add_argument("--seconds", type=float, default=60.0, help="for each target")
    parser.add_argument("--bytes", type=int, default=10_000_000, help="for each target")
    parser.add_argument("--hour", action="store_true", help="one hour in all, whatever the bytes")
    parser.add_argument("--engine", choices=("auto", "atheris", "plain"), default="auto")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--finds", type=Path, default=Path(tempfile.gettempdir()), help="where inputs of finds go")
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    said = parser.parse_args(arguments)
    engine = said.engine
    if engine == "auto":
        engine = "atheris" if importlib.util.find_spec("atheris") else "plain"
    if said.child:
        child(said.targets[0], engine, said.bytes, said.seconds, said.seed)
    names = said.targets or targets()
    seconds, most = (3600.0 / len(names), sys.maxsize) if said.hour else (said.seconds, said.bytes)
    finds = 0
    for name in names:
        found = fuzz(name, engine, most, seconds, said.seed)
        find = found.pop("find")
        if find:
            finds += 1
            print(f"{name}: {find}\n  its input: {keep(name, found, said.finds)}", file=sys.stderr, flush=True)
        found.pop("input", None)
        print(json.dumps({"benchmark": "fuzz", "case": name, "engine": engine, "ok": not find, **found}), flush=True)
    return 1 if finds else 0


if __name__ == "__main__":
    sys.exit(main())
