"""Studies: what the program says about itself, run by the program itself."""
