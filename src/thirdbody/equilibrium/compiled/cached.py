"""Compiled functions that are always run as the cache holds them.

A process that compiles a function binds what it calls to copies that were optimised apart; loaded
from the cache the same function brings its own. The two differ in last digits. So a process of its
own compiles, once after an installation, and every other one loads: the same input gives the same
bytes in the first process, too.
"""

from __future__ import annotations

import base64
import contextlib
import gc
import hashlib
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...quantities.progress import aside

if TYPE_CHECKING:
    from numba.core.codegen import CodeLibrary
    from numba.core.types import Type
    from numba.core.typing import Context, Signature

__all__ = ["Cached"]

COMPILE = (
    "import base64, importlib, pickle, sys; "
    "module, name, signature = sys.argv[1:]; "
    "function = getattr(importlib.import_module(module), name); "
    "function.compile_whole(pickle.loads(base64.b64decode(signature)))"
)
PATIENCE = 600
"""Seconds after which this process compiles for itself."""


def sources() -> str:
    """Digest of the modules from which compiled functions take code and layout.

    numba looks at the module of a function alone.
    """
    about, here = hashlib.sha256(), Path(str(files(__package__)))
    laws = here.parents[1] / "laws"
    others = (here.parent / "engine", laws / "asperity", laws / "particle")
    paths = [*here.glob("*.py"), *(path for folder in others for path in folder.glob("*.py"))]
    for path in sorted(paths):
        about.update(path.read_bytes())
    return about.hexdigest()


class Cached:
    """A numba function with ``cache=True``, to be called like it.

    Parameters
    ----------
    function : numba dispatcher
        Of one module, under the name of this object there.
    """

    def __init__(self, function: Any):
        self.function = function
        self._lock = threading.Lock()
        self._prepared: set[tuple[object, ...]] = set()
        with contextlib.suppress(AttributeError):  # numba's own; without it, its own stamp
            stored = function._cache._cache_file
            stored._source_stamp = stored._source_stamp, sources()

    def __call__(self, *args: object) -> Any:
        kinds = tuple(map(_kind, args))  # cheap, which the types of records are not
        if kinds not in self._prepared:
            with self._lock, aside():
                self._prepare(self._signature(args))
            self._prepared.add(kinds)
        return self.function(*args)

    def compile_whole(self, signature: tuple[Type, ...]) -> None:
        """Compile for these types, in a process of its own: functions that it calls with it.

        numba gathers what every function calls, optimises that and turns it into machine code,
        again for each function above it. Of what is called from here alone, only this one needs it.
        """
        gc.disable()  # a fifth of the time would go into cycles, for a third of a gigabyte
        with contextlib.suppress(ImportError, AttributeError):  # numba's own; without it, as ever
            from numba.core.codegen import JITCodeLibrary, JITCPUCodegen

            name = self.function.py_func.__qualname__
            finalize, set_env = JITCodeLibrary.finalize, JITCPUCodegen.set_env
            pointer_to = JITCodeLibrary.get_pointer_to_function

            def finalize_whole(library: CodeLibrary) -> None:
                if library.name == name:
                    library._linking_libraries = _below(library)
                    finalize(library)
                library._finalized = True

            JITCodeLibrary.finalize = finalize_whole
            JITCodeLibrary.get_pointer_to_function = lambda library, symbol: (
                pointer_to(library, symbol) if library.name == name else 0
            )
            JITCPUCodegen.set_env = lambda codegen, place, env: (
                set_env(codegen, place, env) if f"{len(name)}{name}" in place else None
            )
        _remember_types()
        self.function.compile(signature)

    @staticmethod
    def _signature(args: tuple[object, ...]) -> tuple[Type, ...]:
        from numba import typeof

        return tuple(typeof(argument) for argument in args)

    def is_cached(self, signature: tuple[Type, ...]) -> bool:
        """Whether code for these types lies ready; where numba does not tell, it does."""
        try:
            cache = self.function._cache
            key = cache._index_key(signature, self.function.targetctx.codegen())
            stored = cache._cache_file
            name = stored._load_index().get(key)
            if name is None:
                return False
            with open(stored._data_path(name), "rb"):  # not read: the call does that, slowly
                return True
        except OSError:
            return False
        except AttributeError:
            return True

    def _prepare(self, signature: tuple[Type, ...]) -> None:
        """See that the cache holds the function for these types, if a cache can be written."""
        if signature in self.function.overloads or self.is_cached(signature):
            return
        if sys.stderr.isatty():
            print("thirdbody: compiling the engine, once, some seconds", file=sys.stderr)
        types = base64.b64encode(pickle.dumps(signature)).decode()
        python: Callable[..., object] = self.function.py_func
        command = [sys.executable, "-c", COMPILE, python.__module__, python.__name__, types]
        path = os.pathsep.join(folder for folder in sys.path if folder)
        try:
            subprocess.run(
                command,
                env=os.environ | {"PYTHONPATH": path},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=PATIENCE,
                check=False,
            )
        except (OSError, subprocess.TimeoutExpired):
            return  # compiled here instead, by the call


def _remember_types() -> None:
    """Let numba look up each operator once for its types: some 700 times instead of 24 000.

    What is compiled is the same; a fifth of the time to compile the kernel goes into it.
    """
    with contextlib.suppress(ImportError, AttributeError):  # numba's own; without it, as ever
        from numba.core.types import functions

        base: Any = functions.BaseFunction
        look_up, looked_up = base.get_call_type, {}

        def get_call_type(
            operator: Any,
            context: Context,
            args: tuple[Type, ...],
            named: Mapping[str, Type],
        ) -> Signature | None:
            key = operator, args, tuple(named.items())
            if key not in looked_up:
                signature = look_up(operator, context, args, named)
                if signature is None:
                    return None
                looked_up[key] = signature, operator._impl_keys[signature.args]
            signature, implementation = looked_up[key]
            operator._impl_keys[signature.args] = implementation
            return signature

        base.get_call_type = get_call_type


def _below(library: CodeLibrary) -> list[CodeLibrary]:
    """Code libraries that one needs, each once."""
    libraries: dict[CodeLibrary, None] = {}
    rest = [library]
    while rest:
        for linked in rest.pop()._linking_libraries:
            if linked not in libraries:
                libraries[linked] = None
                rest.append(linked)
    return list(libraries)


def _kind(value: object) -> object:
    """What tells arguments of different numba types apart."""
    if isinstance(value, np.ndarray):
        flags = value.flags
        order = flags.c_contiguous, flags.f_contiguous
        return value.dtype, value.ndim, order, flags.writeable, flags.aligned
    if isinstance(value, tuple):
        return tuple(map(_kind, value))
    return value.dtype if isinstance(value, np.generic) else type(value)
