"""Paints QR codes and barcodes on white cards."""

from __future__ import annotations

import numpy as np
import zxingcpp

MODULE = 8
"""Pixels of the smallest dark or light piece of a code."""
BARS_HEIGHT = 0.45
"""Of a barcode, as a share of its width."""
EAN13, CODE128, QR = "EAN13", "Code128", "QRCode"


def paint_code(form: str, content: str) -> np.ndarray:
    """A code (`QRCode`, `EAN13` or `Code128`) with its quiet zone, (h, w, 3) uint8.

    Raises:
        ValueError: The content does not fit into such a code.
    """
    kind = getattr(zxingcpp.BarcodeFormat, form)
    height = 0 if form == QR else 1
    dark = np.asarray(zxingcpp.write_barcode(kind, content, height=height, quiet_zone=0)) < 128
    if form == QR:
        dark = np.pad(dark, 4)
        bars = np.kron(dark, np.ones((MODULE, MODULE), bool))
    else:
        line = np.pad(dark.any(axis=0), 10)
        wide = np.repeat(line, MODULE)
        height = round(len(wide) * BARS_HEIGHT)
        bars = np.zeros((height, len(wide)), bool)
        bars[6 * MODULE : -6 * MODULE] = wide
    shade = np.where(bars, 18, 243).astype(np.uint8)
    return np.repeat(shade[..., None], 3, axis=2)
