"""The parts of ./ur. Standard library only, Python 3.8 or newer, apart from demo.py and bench.py."""
