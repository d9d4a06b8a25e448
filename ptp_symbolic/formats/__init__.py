"""Files that people write and read: their JSON Schemas, and a platform file to start from.

`platform.schema.json` and `diagnosis.schema.json` in this folder are what `platform_schema` and
`diagnosis_schema` give for the packaged effects.
"""
