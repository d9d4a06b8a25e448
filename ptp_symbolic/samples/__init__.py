"""Sample logs that ship along, made by MuJoCo."""
