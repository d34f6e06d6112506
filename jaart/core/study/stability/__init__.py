"""The stiff and extreme cases, each run through the program as a person would."""
