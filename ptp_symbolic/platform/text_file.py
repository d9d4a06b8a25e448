"""Read a text file of limited size, or refuse it in one line."""

import codecs
from pathlib import Path

from ptp_symbolic.errors import InputError

_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_BY_MARK = {codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}
_OF_WINDOWS = "cp1252"


def read_text_bytes(path: Path, limit: int, kind: str, *, of_instruments: bool = False) -> bytes:
    """Return the content of a text file of at most `limit` bytes as UTF-8, checked, not decoded.

    A byte order mark is dropped and every kind of line end becomes a line feed. Other encodings are
    refused, but for text `of_instruments`: UTF-16 with its mark and Windows-1252, in which western
    spreadsheets and loggers write a degree sign. `kind` says in a refusal what was expected, such
    as "a platform TOML". Raises InputError if the file is missing, not a plain file, too large, or
    not text.
    """
    try:
        if path.is_dir():
            raise InputError(f"{path}: is a folder; give {kind}.")
        if not path.is_file():
            raise InputError(f"{path}: no such file; give the path of {kind}.")
        with path.open("rb") as file:
            content = file.read(limit + 1)
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path}: cannot be read ({reason}); give {kind}.") from error
    if len(content) > limit:
        raise InputError(f"{path}: is larger than {limit // 10**6} MB, the most for {kind}.")
    if of_instruments:
        content = _in_utf8(content)
    _check_text(path, content, kind)
    content = content.removeprefix(_BYTE_ORDER_MARK)
    if b"\r" in content:
        content = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return content


def _in_utf8(content: bytes) -> bytes:
    """Text of another encoding in UTF-8; content that is UTF-8, or no text, as it is."""
    by_mark = next((e for mark, e in _BY_MARK.items() if content.startswith(mark)), None)
    if by_mark is None and (content.startswith(_BYTE_ORDER_MARK) or b"\0" in content):
        return content
    if by_mark is None and _is_utf8(content):
        return content
    text = content if by_mark is None else content[len(codecs.BOM_UTF16) :]
    try:
        return text.decode(by_mark or _OF_WINDOWS).encode()
    except UnicodeDecodeError:
        return content


def _is_utf8(content: bytes) -> bool:
    if content.isascii():  # no copy of a large log
        return True
    try:
        content.decode()
    except UnicodeDecodeError:
        return False
    return True


def _check_text(path: Path, content: bytes, kind: str) -> None:
    zero = content.find(b"\0")
    position, reason = zero, "byte 0x00"
    if zero < 0 and not content.isascii():
        try:
            content.decode()
        except UnicodeDecodeError as error:
            position, reason = error.start, f"byte 0x{content[error.start]:02x}, not UTF-8"
    if position >= 0:
        line = content.count(b"\n", 0, position) + 1
        raise InputError(f"{path}:{line}: is not text ({reason}); give {kind} saved as UTF-8.")
