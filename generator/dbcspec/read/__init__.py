"""Other doors to the model: DBC and what else cantools reads, matrices, spec folders, git."""
