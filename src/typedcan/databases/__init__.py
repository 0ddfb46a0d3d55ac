"""DBC, KCD, SYM and ARXML files to the model, through cantools."""
