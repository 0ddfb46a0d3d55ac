"""Databases of other people, each made into a package that is held against cantools."""
