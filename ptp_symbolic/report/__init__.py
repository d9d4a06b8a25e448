"""Reports that people read: the diagnosis page and the derivation document."""
