"""YAML to the model: tables, errata and behaviour, resolved; and what is changed written back."""
