"""The model to files: each module makes bytes and touches no disk."""
