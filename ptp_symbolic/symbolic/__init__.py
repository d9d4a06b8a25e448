"""The symbolic wing: from bodies and effects to equations, proved, simplified and emitted."""
