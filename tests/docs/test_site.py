"""The built pages: nothing is fetched, no link is dead, every effect and public name is there."""

import html
import re
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import click
import pytest

import ptp_symbolic
from ptp_symbolic.cli.commands import commands
from ptp_symbolic.symbolic.effects import PACKAGED

pytestmark = pytest.mark.early  # they share the built pages

LOADED = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src"}
# A link element that a browser does not load.
NAMED_ONLY = ("canonical", "index", "next", "prev", "search", "author", "copyright", "genindex")


class Page(HTMLParser):
    """What a page loads, where it links to, and the anchors that it has."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.links: list[str] = []
        self.anchors: set[str] = set()
        self.formulas = 0
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.anchors.add(given.get("id", ""))
        self.formulas += tag == "math"
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        if tag in LOADED and LOADED[tag] in given and given.get("rel") not in NAMED_ONLY:
            self.loaded.append(given[LOADED[tag]])


def pages(site: Path) -> Iterator[tuple[Path, Page]]:
    for path in sorted(site.rglob("*.html")):
        if "_static" not in path.parts:
            yield path, Page(path)


def test_no_page_loads_anything_from_a_network(site: Path) -> None:
    found = {path: page.loaded for path, page in pages(site)}
    assert len(found) > len(PACKAGED)
    outside = {(path.name, url) for path, urls in found.items() for url in urls if "//" in url}
    assert outside == set()
    for path, urls in found.items():
        for url in urls:
            assert (path.parent / unquote(urlsplit(url).path)).is_file(), (path.name, url)
    for style in site.rglob("*.css"):
        assert not re.search(r"(url\(|@import)\s*[\"']?https?:", style.read_text("utf-8")), style


def test_no_link_within_the_site_is_dead(site: Path) -> None:
    anchors = {path.resolve(): page.anchors for path, page in pages(site)}
    dead = []
    for path, page in pages(site):
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or link in ("#", ""):
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path.resolve()
            known = target in anchors or target.is_file()
            if not known or (parts.fragment and unquote(parts.fragment) not in anchors[target]):
                dead.append((path.name, link))
    assert dead == []


def test_every_effect_has_its_law_its_parameters_and_its_reference(site: Path) -> None:
    without_law = []
    for effect in PACKAGED:
        path = site / "effects" / f"{effect.id}.html"
        text = path.read_text(encoding="utf-8")
        for kind in (effect, *effect.kinds):
            for parameter in kind.parameters:
                assert parameter.name.replace("{axis}", "‹axis›") in text, (effect.id, parameter)
        assert effect.reference[1:] in html.unescape(text), effect.id
        assert "In a log" in text
        if not Page(path).formulas:
            without_law.append(effect.id)
    assert without_law == []


def test_every_public_name_and_every_command_is_there(site: Path) -> None:
    python = Page(site / "reference" / "python.html").anchors
    names = set(ptp_symbolic.__all__) - {"__version__"}
    assert {name for name in names if f"ptp_symbolic.{name}" not in python} == set()
    text = (site / "reference" / "commands.html").read_text(encoding="utf-8")
    for name, command in commands.commands.items():
        assert f"ptp-symbolic-{name}" in text
        options = [p for p in command.params if isinstance(p, click.Option)]
        assert [o.name for o in options if max(o.opts, key=len) not in text] == []


def test_formulas_are_set_without_a_script(site: Path) -> None:
    page = Page(site / "effects" / "csvs_friction.html")
    assert page.formulas > 3
    assert not any("mathjax" in url.lower() for url in page.loaded)
