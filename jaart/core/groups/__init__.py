"""The parameters by subject; settings.py makes one record of them."""
