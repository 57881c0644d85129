"""Lets `python -m roadbed_cluster` do what `roadbed-cluster` does."""

import sys

from roadbed_cluster.command_line import main

sys.exit(main())
