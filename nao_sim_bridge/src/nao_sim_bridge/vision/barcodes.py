"""Reads barcodes and QR codes, with zxing-cpp: it reads QR codes from twice as far as OpenCV does, and stripes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Tuple

import cv2
import numpy as np
import zxingcpp

from nao_sim_bridge.cameras.optics import Optics

Corner = Tuple[float, float]

# Those that check themselves: others are read now and then where there are only stripes.
FORMATS = (
    zxingcpp.BarcodeFormat.QRCode
    | zxingcpp.BarcodeFormat.MicroQRCode
    | zxingcpp.BarcodeFormat.DataMatrix
    | zxingcpp.BarcodeFormat.Aztec
    | zxingcpp.BarcodeFormat.PDF417
    | zxingcpp.BarcodeFormat.EAN13
    | zxingcpp.BarcodeFormat.EAN8
    | zxingcpp.BarcodeFormat.UPCA
    | zxingcpp.BarcodeFormat.UPCE
    | zxingcpp.BarcodeFormat.Code128
)
ENLARGED = ((400, 3), (700, 2))
"""Widths up to which pictures are looked at enlarged as well, pixels, and how much: of QR codes whose modules are 1.2
to 2.5 pixels wide, 30 % were read as they were and 85 % enlarged."""
SHARPEN = 1.5
MODULES = {"EAN13": 95, "EAN8": 67, "UPCA": 95, "UPCE": 51}
"""Of the codes whose one check digit lets a tenth of all wrong readings through: how many modules they are wide."""
LEAST_MODULE = 1.2
"""Pixels; with narrower modules a tenth of the article numbers was read wrongly."""
AROUND = 0.2
"""How much around such a code is looked at again, as a share of its length."""


@dataclass(frozen=True)
class Barcode:
    """A code in a picture; its kind is its format, for example "QRCode".

    Its corners are in pixels: upper left, upper right, lower right and lower left one, as the code is read. Of stripes
    they are the ends of the line along which they were read, each twice.
    """

    text: str
    kind: str
    corners: Tuple[Corner, Corner, Corner, Corner]


class BarcodeDetector:
    """All codes in a picture, from left to right."""

    def detect(self, image: np.ndarray, optics: Optics, _: Any = None) -> list[Barcode]:
        """The codes in a picture; see `Detector`."""
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        factor = next((factor for width, factor in ENLARGED if grey.shape[1] <= width), 1)
        codes = _read(grey, 1)
        if factor > 1:  # article numbers were often wrong in the picture as it is
            codes = [code for code in codes if code.kind not in MODULES] + _read(_enlarged(grey, factor), factor)
        found = {}
        for code in codes:
            if (code.kind, code.text) not in found and (code.kind not in MODULES or _confirmed(code, grey, factor + 1)):
                found[code.kind, code.text] = code
        return sorted(found.values(), key=lambda code: code.corners)


def _confirmed(code: Barcode, grey: np.ndarray, factor: int) -> bool:
    """Whether an article number is read again in a part of the picture that is enlarged differently."""
    corners = np.array(code.corners)
    length = float(np.linalg.norm(corners[1] - corners[0]))
    if length < LEAST_MODULE * MODULES[code.kind]:
        return False
    low = np.maximum(corners.min(axis=0) - AROUND * length, 0).astype(int)
    high = (corners.max(axis=0) + AROUND * length).astype(int)
    part = _enlarged(grey[low[1] : high[1], low[0] : high[0]], factor)
    return code.text in (again.text for again in _read(part, factor))


def _enlarged(grey: np.ndarray, factor: int) -> np.ndarray:
    """Larger and sharper."""
    large = cv2.resize(grey, None, fx=factor, fy=factor, interpolation=cv2.INTER_CUBIC)
    soft = cv2.GaussianBlur(large, (0, 0), float(factor))
    return cv2.addWeighted(large, 1.0 + SHARPEN, soft, -SHARPEN, 0.0)


def _read(grey: np.ndarray, factor: int) -> list[Barcode]:
    codes = []
    for result in zxingcpp.read_barcodes(grey, formats=FORMATS):
        if not result.valid or not result.text:
            continue
        place = result.position
        corners = (place.top_left, place.top_right, place.bottom_right, place.bottom_left)
        codes.append(Barcode(result.text, result.format.name, tuple((c.x / factor, c.y / factor) for c in corners)))
    return codes
