"""XML of others as a tree that knows its lines, read without entities and without network."""

import io
import math
import xml.sax
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.sax.handler import ContentHandler
from xml.sax.xmlreader import InputSource

import defusedxml
import defusedxml.sax
import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform.fields import shown
from ptp_symbolic.platform.text_file import read_text_bytes

FloatArray = NDArray[np.float64]
_MAX_BYTES = 10_000_000
_DEEPEST = 100  # elements within elements; a tree of bodies is walked by recursion


@dataclass
class Element:
    """An element: its tag, attributes, children, and `file`:`line` where it begins."""

    tag: str
    attributes: dict[str, str]
    file: str
    line: int
    children: list["Element"] = field(default_factory=list)

    @property
    def where(self) -> str:
        """File and line, as refusals begin."""
        return f"{self.file}:{self.line}"

    @property
    def name(self) -> str:
        """The attribute `name`, empty where there is none."""
        return self.attributes.get("name", "")

    def refused(self, message: str) -> InputError:
        """A refusal that names the line of the element and its tag."""
        return InputError(f"{self.where}: <{self.tag}>: {message}")

    def all(self, tag: str) -> list["Element"]:
        """Its children with a tag."""
        return [child for child in self.children if child.tag == tag]

    def first(self, tag: str) -> "Element | None":
        """Its child with a tag; raises InputError where there are several."""
        found = self.all(tag)
        if len(found) > 1:
            raise found[1].refused(f"a second <{tag}> in one <{self.tag}>; remove one.")
        return found[0] if found else None

    def required(self, attribute: str) -> str:
        """The text of an attribute; raises InputError where there is none."""
        if not self.attributes.get(attribute, "").strip():
            raise self.refused(f"has no attribute {attribute}; add it.")
        return self.attributes[attribute]

    def numbers(self, attribute: str, count: int, default: Any = None) -> FloatArray:
        """An attribute as `count` finite numbers; `default` where it is not given. Raises
        InputError for another count, for what is no number, and where there is no default.
        """
        if attribute not in self.attributes and default is not None:
            return np.array(default, dtype=float)
        words = self.required(attribute).split()
        try:
            found = [float(word) for word in words if "_" not in word]
        except ValueError:
            found = []
        if len(found) != count or len(words) != count or not all(map(math.isfinite, found)):
            many = "a finite number" if count == 1 else f"{count} finite numbers"
            given = shown(self.attributes[attribute])
            raise self.refused(f"{attribute} = {given} is not {many}; write {many}.")
        return np.array(found)

    def number(self, attribute: str, default: float | None = None) -> float:
        """An attribute as one finite number; see `numbers`."""
        (found,) = self.numbers(attribute, 1, None if default is None else [default])
        return float(found)

    def positive(self, attribute: str, default: float | None = None) -> float:
        """A number that is zero or more."""
        found = self.number(attribute, default)
        if found < 0.0:
            raise self.refused(f"{attribute} = {found:g} is negative; give zero or more.")
        return found


def read_xml(path: Path) -> Element:
    """The root element of an XML file of at most 10 MB.

    Raises InputError (one line) for a file that is missing, unreadable, not XML, has a document
    type or entities, or is nested more than 100 deep.
    """
    content = read_text_bytes(path, _MAX_BYTES, "a URDF or MJCF file")
    builder = _Builder(str(path))
    source = InputSource()
    source.setByteStream(io.BytesIO(content))
    source.setEncoding("utf-8")
    reader = defusedxml.sax.make_parser()
    reader.forbid_dtd = True
    reader.setContentHandler(builder)
    try:
        reader.parse(source)
    except xml.sax.SAXParseException as wrong:
        line = wrong.getLineNumber()
        raise InputError(f"{path}:{line}: is not XML: {wrong.getMessage()}.") from wrong
    except defusedxml.DefusedXmlException as wrong:
        raise InputError(
            f"{path}: has a document type or entities (<!DOCTYPE ...>); remove them, they are not"
            " read."
        ) from wrong
    assert builder.root is not None  # expat refuses a document without an element
    return builder.root


class _Builder(ContentHandler):
    """Makes elements of what the reader reports."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self.file = file
        self.root: Element | None = None
        self.open: list[Element] = []

    def setDocumentLocator(self, locator: Any) -> None:
        self.locator = locator

    def startElement(self, name: str, attrs: Any) -> None:
        element = Element(name, dict(attrs.items()), self.file, self.locator.getLineNumber())
        if len(self.open) >= _DEEPEST:
            raise element.refused(f"is more than {_DEEPEST} elements deep; flatten the file.")
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def endElement(self, name: str) -> None:
        self.open.pop()
