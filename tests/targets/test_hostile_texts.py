"""No name and no text of a platform or an effect breaks or enters what is written for others."""

import ast
import ctypes
import html.parser
import re
import resource
import shutil
import subprocess
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.models.export import exported
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.report.derivation import render_derivation
from ptp_symbolic.report.diagnosis import render_diagnosis
from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.effects import on_trial
from ptp_symbolic.symbolic.program.program import Program, program
from ptp_symbolic.symbolic.symbols import real
from ptp_symbolic.symbolic.targets import TARGETS
from ptp_symbolic.symbolic.targets.c99 import C99_DOUBLE, C99_FLOAT
from ptp_symbolic.symbolic.targets.c99 import _sizes as sizes_in_c
from ptp_symbolic.symbolic.targets.numba.module import written
from ptp_symbolic.symbolic.targets.words import WORDS
from tests.effects.plain_python import module_as_python
from tests.report.synthetic_diagnosis import synthetic_curves, synthetic_diagnosis
from tests.targets.c_library import COMPILERS, STRICT, compiled, pointer

TEXTS = {
    "tex": r"\input{secret} \end{document} $x^{2}_3$ % & # ~ {",
    "c": r'*/ int main(void) { return 1; } /* ??/ // \ " #include "secret"',
    "xml": "]]> --> <!-- <!DOCTYPE a> <body/> &amp; &#0; --",
    "html": "</title></script><script>alert(1)</script><img src=x onerror=alert(1)>",
    "python": "\"\"\"\nimport os\n'''{0} %s \\x00 \\N{DASH}",
    "quotes": "\"'`$(touch mark)`'\"",
    "octave": "' ]; system('touch mark'); % \" #{\n...",
    "control": "a\x00b\x07c\x1b[31md\x85e\u2028f\u202eg\r\nh\ti",
    "long": "long " * 400,
    "other": "Schwenk \u03b8 \u4e91\u53f0",
}
FORWARDS, BACKWARDS = " ".join(TEXTS.values()), " ".join(reversed(TEXTS.values()))
TAKEN = (  # words of C, its headers, this source, Octave, Python, CasADi, JAX, with twins
    *("double", "double_", "register", "int", "auto", "restrict", "INFINITY", "NAN", "gamma", "y0"),
    *("STATES", "MODES", "RIGID", "REAL", "MAX", "real", "model_gain", "MODEL_GAIN", "sinf"),
    *("end", "endif", "function", "choice", "Inf", "nan", "NA", "eps", "ans", "i", "pi"),
    *("ca", "jnp", "jax", "list", "len", "print", "True_", "value", "machine", "NULL"),
)


def opposed(place: Place) -> Contribution:
    """A torque that tells every parameter from every other."""
    own = [real(name) for name in TAKEN]
    total = sum(((k + 1) * p for k, p in enumerate(own)), start=real(TAKEN[0]))
    return Contribution(torques={place.rate: -total * place.rate})


def opposed_by_three(place: Place) -> Contribution:
    """A torque of the first three parameters."""
    return Contribution(torques={place.rate: -sum(map(real, TAKEN[:3])) * place.rate})


HOSTILE = Effect(
    id="hostile",
    title=TEXTS["tex"] + TEXTS["html"],
    reference=TEXTS["python"] + TEXTS["c"],
    parameters=tuple(
        Parameter(name, "N m s/rad", 0.1 + 0.01 * k, 0.0, 9.0, TEXTS["html"] + TEXTS["tex"])
        for k, name in enumerate(TAKEN)
    ),
    contribute=opposed,
)


def turntable(title: str) -> Platform:
    """One axis with the effect above."""
    effects = (EffectDeclaration("rigid_bodies", None, None),)
    effects += (EffectDeclaration("hostile", "pan", None),)
    return Platform("turntable", title, ("pan",), 9.81, effects, (), ())


@pytest.fixture(autouse=True)
def own_effect(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The effect can be declared; whatever is run, nothing of its texts is."""
    monkeypatch.chdir(tmp_path)
    with on_trial(HOSTILE):
        yield
    assert not (tmp_path / "mark").exists()


@pytest.fixture(scope="module")
def whole() -> Program:
    with on_trial(HOSTILE):
        return program(assemble(turntable("Turntable")))


def exactly(whole: Program, rate: float) -> float:
    """Acceleration of the pan axis by hand."""
    p = {q.name: q.default for q in whole.equations.parameters}
    total = sum((k + 1) * p[name] for k, name in enumerate(TAKEN)) + p[TAKEN[0]]
    return -total * rate / p["J_pan"]


def test_names_that_are_words_are_names_in_c(whole: Program, tmp_path: Path) -> None:
    for compiler in COMPILERS:
        library = ctypes.CDLL(str(compiled(whole, "machine", C99_DOUBLE, tmp_path, compiler)))
        p = np.array([q.default for q in whole.equations.parameters])
        given = {"t": 0.0, "x": np.array([0.3, 0.7]), "p": p, "dx": np.zeros(2)}
        kernel = next(k for k in whole.kernels if k.name == "mode_derivative")
        arrays = [given.get(a, np.zeros(1)) for a in kernel.arguments]
        numbers = [ctypes.c_double(a) if isinstance(a, float) else pointer(a) for a in arrays]
        library.machine_mode_derivative(*numbers)
        dx = given["dx"]
        assert dx[1] == pytest.approx(exactly(whole, 0.7), rel=1e-13)
        names = (ctypes.c_char_p * len(p)).in_dll(library, "machine_parameter_names")
        assert [n.decode() for n in names if n] == [q.name for q in whole.equations.parameters]
    if COMPILERS:
        compiled(whole, "machine", C99_FLOAT, tmp_path, COMPILERS[0])


def test_names_that_are_words_are_names_in_numba(whole: Program) -> None:
    dx = np.zeros(2)
    p = np.array([q.default for q in whole.equations.parameters])
    module_as_python(written(whole)).state_derivative(0.0, [0.3, 0.7], np.zeros(1), p, dx)
    assert dx[1] == pytest.approx(exactly(whole, 0.7), rel=1e-13)


@pytest.mark.parametrize("target", ["casadi", "jax"])
def test_names_that_are_words_are_names_in_python(target: str, whole: Program) -> None:
    pytest.importorskip(target)
    (text,) = next(t for t in TARGETS if t.name == target).files(whole, "machine").values()
    module: dict[str, object] = {}
    exec(compile(text, "machine", "exec"), module)
    p = np.array(module["PARAMETERS"])
    found = module["vector_field"](0.0, np.array([0.3, 0.7]), np.zeros(1), p, np.zeros(0))
    assert float(found[1]) == pytest.approx(exactly(whole, 0.7), rel=1e-13)


def test_names_that_are_words_are_names_in_octave(whole: Program, tmp_path: Path) -> None:
    if shutil.which("octave-cli") is None:
        pytest.skip("octave is not installed")
    for file, text in (
        next(t for t in TARGETS if t.name == "octave").files(whole, "machine").items()
    ):
        (tmp_path / file).write_text(text)
    call = "machine_vector_field(0, [0.3; 0.7], [0], m.parameters, [])"
    script = f"m = machine_model(); dx = {call}; printf('%.17g', dx(2))"
    words = ["octave-cli", "--norc", "--eval", script]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert float(done.stdout) == pytest.approx(exactly(whole, 0.7), rel=1e-13)


def test_names_that_are_others_are_the_same_everywhere_and_said(whole: Program) -> None:
    said = [
        tuple(text for text in target.remarks(whole) if "no binary for" not in text)
        for target in TARGETS
        if target.name not in ("mjcf", "urdf", "numba", "numba-float")  # names are as they are
    ]
    assert len(set(said)) == 1
    assert "'double' is a word of a language: its variable is double_" in said[0]
    assert "'double_' is a word of a language: its variable is double__" in said[0]
    assert set(sizes_in_c(whole)) <= WORDS


@pytest.mark.parametrize("name", ["lambda", "a b", 'x"; y', "\u03b8", "9", "x", "", "a-b"])
def test_what_is_no_name_is_refused(name: str) -> None:
    one = replace(HOSTILE.parameters[0], name=name)

    def torque(place: Place) -> Contribution:
        return Contribution(torques={place.rate: -real(name) * place.rate})

    refused = pytest.raises(ValueError, match=r"has no valid name|use for themselves")
    with on_trial(replace(HOSTILE, parameters=(one,), contribute=torque)), refused:
        assemble(turntable("Turntable"))


class Tags(html.parser.HTMLParser):
    """Tags and their attributes, without what is written between them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, tuple[str, ...]]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, tuple(name for name, _ in attrs)))


def code_of(file: str, text: str, folder: Path) -> object:
    """What of a file is no comment and no text; it must be whole."""
    if file.endswith((".c", ".h")):
        return code_of_c(Path(file).name, text, folder)
    if file.endswith(".py"):
        tree = ast.parse(text)
        return ast.dump(ast.Module([n for n in tree.body if not _is_text(n)], []))
    if file.endswith((".xml", ".urdf")):
        return [(e.tag, sorted(e.attrib)) for e in ET.fromstring(text).iter()]
    return text


def code_of_c(file: str, text: str, folder: Path) -> str | None:
    """C without comments and the contents of its texts; what includes nothing strange compiles."""
    (folder / file).write_text(text, encoding="utf-8")
    if not COMPILERS:
        return None
    included = set(re.findall(r"^#include [<\"](.*?)[>\"]", text, flags=re.M))
    if included <= {"math.h", f"{Path(file).stem}.h"}:
        words = [COMPILERS[0], *STRICT, "-fsyntax-only", file]
        subprocess.run(words, cwd=folder, check=True, capture_output=True)
    stripped = [COMPILERS[0], "-std=c99", "-fpreprocessed", "-dD", "-E", "-P", file]
    ran = subprocess.run(stripped, cwd=folder, check=True, capture_output=True, text=True)
    return re.sub(r'"(\\.|[^"\\])*"', '""', ran.stdout)


def _is_text(node: ast.stmt) -> bool:
    value = node.value if isinstance(node, ast.Expr | ast.Assign) else None
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


@pytest.mark.parametrize("title", [FORWARDS, BACKWARDS], ids=["forwards", "backwards"])
@pytest.mark.parametrize("target", [t.name for t in TARGETS])
def test_a_title_is_no_code(target: str, title: str, whole: Program, tmp_path: Path) -> None:
    """But for comments and texts the files are those of a plain title, and whole."""
    named = replace(whole, equations=replace(whole.equations, title=title))

    def files(of: Program) -> dict[str, str | bytes]:
        return dict(next(t for t in TARGETS if t.name == target).files(of, "turntable"))

    plain, hostile = files(whole), files(named)
    assert list(plain) == list(hostile)
    for file, text in hostile.items():
        if isinstance(text, bytes):
            continue
        assert not re.search(r"[\x00-\x08\x0b-\x1f\x7f\x1b]", text), file
        assert code_of(file, text, tmp_path) == code_of(file, plain[file], tmp_path), file


def test_a_title_is_no_tex() -> None:
    """The document is that of a plain title but for the title, in which nothing is a command."""
    title = " ".join(TEXTS[kind] for kind in ("tex", "c", "xml", "html", "quotes", "octave"))
    title = " ".join(title.split())
    few = replace(HOSTILE, parameters=HOSTILE.parameters[:3], contribute=opposed_by_three)
    with on_trial(few):
        plain, hostile = (
            re.sub(
                "[0-9a-f]{64}", "HASH", str(render_derivation(turntable(each))["derivation.tex"])
            )
            for each in ("Turntable", title)
        )
    assert hostile.replace(escaped(title), "Turntable") == plain
    commands = set(re.findall(r"\\([a-zA-Z]+|.)", escaped(title)))
    assert commands == {"textbackslash", "textasciitilde", "textasciicircum", *"&%$#_{}"}
    assert not re.search(r"(?<!\\)[&%$#_~^]", escaped(title))
    assert r"\input{" not in plain and plain.count(r"\end{document}") == 1


@pytest.mark.long
def test_a_document_of_hostile_texts_compiles(tmp_path: Path) -> None:
    """TeX stops at the first error: nothing in a title, a meaning or a reference is a command."""
    if shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    few = replace(HOSTILE, parameters=HOSTILE.parameters[:3], contribute=opposed_by_three)
    with on_trial(few):
        files = render_derivation(turntable(" ".join(TEXTS["tex"].split()) + TEXTS["html"]))
    for name, content in files.items():
        (tmp_path / name).write_bytes(content.encode() if isinstance(content, str) else content)
    words = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape"]
    subprocess.run([*words, "derivation.tex"], cwd=tmp_path, check=True, capture_output=True)


def test_texts_are_no_html() -> None:
    """A page has the elements that it has with plain texts, whatever files and effects say."""

    def elements(text: str) -> list[tuple[str, tuple[str, ...]]]:
        diagnosis = synthetic_diagnosis("explained")
        diagnosis["platform"]["title"] = diagnosis["summary"] = text
        diagnosis["hints"], diagnosis["refused"] = [text], {"hostile@pan": text}
        diagnosis["error"]["definition"] = text
        for quantity in diagnosis["fit"]["before"]["parameters"].values():
            quantity["meaning"] = text
        return Tags(render_diagnosis(diagnosis, synthetic_curves(samples=50))).found

    assert elements(FORWARDS) == elements("plain")


@pytest.mark.parametrize("target", [t.name for t in TARGETS])
def test_a_full_disk_leaves_nothing(target: str, tmp_path: Path) -> None:
    """The system itself refuses to write more than some bytes per file: the export, or a compiler
    of another system that it calls.
    """
    platform = read_platform("thesis-ideal")
    largest = max(map(len, exported(platform, target).files.values()))
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    (tmp_path / "old").mkdir()
    (tmp_path / "old" / "kept.txt").write_text("kept")
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest // 2, hard))
    try:
        for folder in ("new", "old"):
            with pytest.raises(ptp.InputError, match="File too large"):
                ptp.export(platform, target, tmp_path / folder)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["kept.txt", "old"]
    with pytest.raises(ptp.InputError, match="is not a folder"):
        ptp.export(platform, target, tmp_path / "old" / "kept.txt" / "deeper")
