"""`python -m roadbed` runs the program."""

from roadbed._program import main

main()
