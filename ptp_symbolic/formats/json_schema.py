"""Pieces of JSON Schemas (draft 7, which editors of TOML read)."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

Schema = dict[str, Any]

DRAFT = "http://json-schema.org/draft-07/schema#"
TEXT: Schema = {"type": "string"}
NUMBER: Schema = {"type": "number"}
WHOLE: Schema = {"type": "integer"}
TRUTH: Schema = {"type": "boolean"}


def record(
    entries: Mapping[str, Schema], optional: Sequence[str] = (), description: str = ""
) -> Schema:
    """An object that has all of `entries`, but for those that are `optional`, and no other."""
    required = [name for name in entries if name not in optional]
    found: Schema = {"type": "object", "properties": dict(entries), "additionalProperties": False}
    if required:
        found["required"] = required
    return said(found, description)


def table_of(value: Schema, description: str = "") -> Schema:
    """An object with any keys whose values are all as `value`."""
    return said({"type": "object", "additionalProperties": value}, description)


def list_of(item: Schema, description: str = "", count: int | None = None) -> Schema:
    """An array of `item`, of `count` of them where that is given."""
    found: Schema = {"type": "array", "items": item}
    if count is not None:
        found |= {"minItems": count, "maxItems": count}
    return said(found, description)


def one_of(choices: Sequence[str], description: str = "") -> Schema:
    """One of these texts."""
    return said({"enum": list(choices)}, description)


def or_none(schema: Schema, description: str = "") -> Schema:
    """What `schema` says, or null."""
    return said({"anyOf": [schema, {"type": "null"}]}, description)


def said(schema: Schema, description: str) -> Schema:
    """`schema` with a description, where there is one."""
    return {**schema, "description": description} if description else schema


def schema_text(schema: Schema) -> str:
    """The text of the file that holds `schema`."""
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"
