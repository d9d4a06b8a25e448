"""Compiled functions that numba keeps on disk, each file with its checksum.

numba runs what it finds. After a loss of power, or on a full disk, a file may be empty, cut off or
zeroed in the middle, which ends in a traceback of its own or in the end of the process. Files of
functions of this package carry a SHA-256 behind what numba reads: where it does not fit, the
function is compiled and kept anew. Where nothing can be kept, it is compiled in every process.
They lie beside the source, or in NUMBA_CACHE_DIR, where checkouts at different places share them.
What came with the installation (see `shipped`) is taken first.

To import this module is to have it so, for functions that are decorated later.
"""

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BytesIO
from pathlib import Path
from types import FunctionType
from typing import Any

from numba.core import caching, config, dispatcher
from numba.core.runtime import rtsys

from ptp_symbolic.numeric.runtime import shipped

ROOTS = ("ptp_symbolic", "generated")  # packages whose functions are ours
EMITTED = "ptp_model_"  # how the modules of a user's machines are called
DIGEST = hashlib.sha256().digest_size


class SealedFiles(caching.IndexDataCacheFile):
    """Index and data files of one function, read only where their checksum fits."""

    def _load_index(self) -> dict[Any, str]:
        return super()._load_index() if _is_whole(self._index_path) else {}

    def _load_data(self, name: str) -> Any:
        if not _is_whole(self._data_path(name)):
            raise FileNotFoundError(name)
        return super()._load_data(name)

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[BytesIO]:
        content = BytesIO()
        yield content
        written = content.getvalue()
        with super()._open_for_write(filepath) as file:
            file.write(written + hashlib.sha256(written).digest())


class SealedCache(caching.FunctionCache):
    """What numba keeps of one function, in sealed files."""

    def __init__(self, py_func: FunctionType) -> None:
        super().__init__(py_func)
        if config.CACHE_DIR:  # by the name of the module: the same for every checkout
            self._cache_path = os.path.join(config.CACHE_DIR, py_func.__module__)
            os.makedirs(self._cache_path, exist_ok=True)
        stamp = self._impl.locator.get_source_stamp()
        self._cache_file = SealedFiles(self._cache_path, self._impl.filename_base, stamp)

    def load_overload(self, signature: Any, target: Any) -> Any:
        """The compiled function, or None where there is none that can be used.

        numba would first load all that it compiles with, a third of a second: whoever compiles
        loads that then.
        """
        rtsys.initialize(target)
        with suppress(OSError):
            if shipped.fits():
                name = self._shipped_name(signature, target)
                came_along = SealedFiles(str(shipped.FOLDER), name, None)._load_data(name)
                return self._impl.rebuild(target, came_along)
        with suppress(OSError):
            return self._load_overload(signature, target)
        return None

    def save_overload(self, signature: Any, data: Any) -> None:
        """Keep the compiled function, where that is possible."""
        with suppress(OSError):
            super().save_overload(signature, data)
        if folder := os.environ.get(shipped.WRITE_INTO):
            name = self._shipped_name(signature, data.target_context)
            SealedFiles(folder, name, None)._save_data(name, self._impl.reduce(data))

    def _shipped_name(self, signature: Any, target: Any) -> str:
        _, _, code = self._index_key(signature, target.codegen())
        return shipped.name_of(self._py_func, signature, code)


def _is_whole(path: str) -> bool:
    """Whether the file at `path` ends with the checksum of what is before it."""
    try:
        content = Path(path).read_bytes()
    except OSError:
        return False
    return hashlib.sha256(content[:-DIGEST]).digest() == content[-DIGEST:]


def _cache_of(py_func: FunctionType) -> caching.Cache | caching.NullCache:
    """The cache of a function: sealed if it is ours, none where none can be."""
    root = py_func.__module__.split(".")[0]
    if root not in ROOTS and not root.startswith(EMITTED):
        return caching.FunctionCache(py_func)
    try:
        return SealedCache(py_func)
    except (OSError, RuntimeError):  # no folder to keep it in
        return caching.NullCache()


vars(dispatcher)["FunctionCache"] = _cache_of
