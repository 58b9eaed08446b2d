"""Files that are in memory alone."""

from __future__ import annotations

import os
from contextlib import contextmanager
from typing import Iterator


@contextmanager
def memory_file(content: bytes) -> Iterator[str]:
    """Path of a file for libraries that read nothing else; it takes no room on a disk."""
    descriptor = os.memfd_create("nao_sim")
    try:
        with os.fdopen(os.dup(descriptor), "wb") as file:
            file.write(content)
        yield f"/proc/self/fd/{descriptor}"
    finally:
        os.close(descriptor)
