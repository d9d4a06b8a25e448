"""Public data of real machines taken through the tool: a study made with the package."""
