"""Figures: one file each, from a record to a matplotlib figure; the window and the command line draw the same."""
