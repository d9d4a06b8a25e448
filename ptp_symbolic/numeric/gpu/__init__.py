"""Many trajectories of one model on a GPU, one per thread."""
