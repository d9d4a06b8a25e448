"""The next experiment: the input that tells rival models apart, or a parameter best."""
