"""Python runs this at its start, in every process that has the folder on its path: see blocks.py."""

import os

if os.environ.get("FAULTS_REACH"):
    import blocks

    blocks.install(os.environ["FAULTS_REACH"])
