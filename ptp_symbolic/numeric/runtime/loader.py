"""Load emitted modules, committed or from a cache folder, after verifying their checksum."""

import hashlib
import importlib
import importlib.util
import sys
from dataclasses import replace
from functools import lru_cache
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import Platform, read_platform

TRAILER = "# END sha256 "
COMMITTED = {
    "ideal": "thesis-ideal",
    "payload": "thesis-payload",
    "pan_drive": "thesis-pan-drive",
    "tilt_drive": "thesis-tilt-drive",
    "full": "thesis-full",
}


def generated_folder() -> Path:
    """Folder of the committed modules."""
    return Path(next(iter(importlib.import_module("ptp_symbolic.generated").__path__)))


def model_names() -> tuple[str, ...]:
    """Names of the committed models."""
    return tuple(sorted(p.stem for p in generated_folder().glob("*.py") if p.stem != "__init__"))


def load_model(name: str) -> Model:
    """Load a committed model by name.

    Raises InputError for an unknown name or a module whose text does not fit its checksum.
    """
    if name not in model_names():
        raise unknown("model", name, model_names())
    found = load_module(generated_folder() / f"{name}.py", f"ptp_symbolic.generated.{name}")
    preset = COMMITTED.get(name)
    return found if preset is None else replace(found, platform=_preset(preset))


@lru_cache(maxsize=len(COMMITTED))
def _preset(name: str) -> Platform:
    return read_platform(name)


def load_module(path: Path, import_name: str) -> Model:
    """Load the emitted module at `path` under `import_name` (one name per module).

    Raises InputError when the text of the module does not fit its checksum or cannot be imported.
    """
    from ptp_symbolic.numeric.runtime import compiled  # noqa: F401

    verify(path)
    if import_name in sys.modules:
        return Model(sys.modules[import_name])
    loader = _FromSource(import_name, str(path))
    spec = importlib.util.spec_from_loader(import_name, loader)
    if spec is None:
        raise InputError(f"{path} cannot be imported; regenerate it.")
    module: ModuleType = importlib.util.module_from_spec(spec)
    sys.modules[import_name] = module
    try:
        loader.exec_module(module)
    except BaseException:
        del sys.modules[import_name]
        raise
    return Model(module)


class _FromSource(SourceFileLoader):
    """Runs the text whose checksum was verified: bytecode beside it may be another's."""

    def get_code(self, fullname: str) -> CodeType:
        """The code of the text, compiled anew."""
        path = self.get_filename(fullname)
        return self.source_to_code(self.get_data(path), path)


def verify(path: Path) -> None:
    """Raise InputError unless the last line of `path` is the SHA-256 of everything above it."""
    above, found, digest = path.read_bytes().rpartition(TRAILER.encode())
    if not found or hashlib.sha256(above).hexdigest().encode() != digest.strip():
        raise InputError(
            f"{path.name} does not fit its checksum: it was edited or truncated; run"
            " 'ptp-symbolic regenerate'."
        )
