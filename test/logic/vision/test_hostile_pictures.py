"""Pictures that claim to be huge or need a decoder that is not trusted: refused by their first bytes."""

from __future__ import annotations

import io
import struct
import zlib

import cv2
import numpy as np
import PIL.Image
import PIL.ImageFile
import PIL.WebPImagePlugin
import pytest
from camera_topics import compressed
from sensor_msgs.msg import Image

from nao_library_modules.vision import pictures as vision_pictures
from nao_library_modules.vision.pictures import BadPicture, picture_of, scaled
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.world.pictures import WorldPicture, aspect

# Blue grows to the right, red downwards.
COLOURS = np.stack(np.broadcast_arrays(6 * np.arange(40), 100, 10 * np.arange(24)[:, None]), axis=2).astype(np.uint8)


def file_of(kind, **options):
    content = io.BytesIO()
    PIL.Image.fromarray(COLOURS[:, :, ::-1]).save(content, kind, **options)
    return content.getvalue()


def png(width, height):
    """A few bytes that claim to be a picture of that size."""
    content = b"\x89PNG\r\n\x1a\n"
    for name, data in ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(b""))):
        content += struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    return content


def jpeg(width, height):
    """A real one, whose header claims that size."""
    content = file_of("JPEG")
    return content.replace(struct.pack(">HH", 24, 40), struct.pack(">HH", height, width))


def webp(width, height):
    """A real one."""
    content = io.BytesIO()
    PIL.Image.new("RGB", (width, height)).save(content, "WEBP", lossless=True, quality=0, method=0)
    return content.getvalue()


@pytest.mark.parametrize("kind, options, close", [
    ("JPEG", {}, 8), ("JPEG", {"progressive": True}, 8), ("PNG", {}, 0), ("WEBP", {}, 8),
    ("WEBP", {"lossless": True}, 0), ("WEBP", {"exif": b"Exif\0\0MM\0*\0\0\0\x08\0\0"}, 8),
])  # fmt: skip
def test_what_is_allowed_is_decompressed(kind, options, close, tmp_path):
    content = file_of(kind, **options)
    assert np.abs(picture_of(compressed(0.0, content)).astype(int) - COLOURS).mean() <= close
    path = tmp_path / "picture"
    path.write_bytes(content)
    assert aspect(WorldPicture("file", str(path))) == 40 / 24


def test_grey_of_sixteen_bits_becomes_a_picture_as_others_do():
    grey = np.array([[0, 256, 65535]], np.uint16)
    picture = picture_of(compressed(0.0, cv2.imencode(".png", grey)[1].tobytes()))
    assert picture[0].tolist() == [[0] * 3, [1] * 3, [255] * 3]


@pytest.mark.parametrize("make", [png, jpeg, webp])
def test_a_claim_of_too_many_pixels_is_refused_before_anything_is_decoded(make, tmp_path, monkeypatch):
    for decoder in (PIL.ImageFile.ImageFile, PIL.WebPImagePlugin.WebPImageFile, cv2):
        monkeypatch.setattr(decoder, "imdecode" if decoder is cv2 else "load", None)
    with pytest.raises(BadPicture, match="it is 9000x100 pixels; up to 8192 a side and 33554432 of all are allowed"):
        picture_of(compressed(0.0, make(9000, 100)))
    path = tmp_path / "picture"
    path.write_bytes(make(8000, 8000))
    with pytest.raises(BadPicture, match="it is 8000x8000 pixels"):
        picture_of(compressed(0.0, path.read_bytes()))
    with pytest.raises(BadValue, match="it has 8000x8000 pixels, at most 16384 a side and 50000000 of all are allowed"):
        aspect(WorldPicture("file", str(path)))


def moving():
    one, other = PIL.Image.new("RGB", (4, 4)), PIL.Image.new("RGB", (4, 4), (255, 0, 0))
    content = io.BytesIO()
    one.save(content, "WEBP", save_all=True, append_images=[other])
    return content.getvalue()


WRONG = {
    "jpeg 2000": (file_of("JPEG2000"), "none of JPEG, PNG, WEBP"),
    "jpeg 2000 stream": (b"\xff\x4f\xff\x51" + bytes(60), "none of JPEG, PNG, WEBP"),
    "tiff": (file_of("TIFF"), "none of JPEG, PNG, WEBP"),
    "bmp": (file_of("BMP"), "none of JPEG, PNG, WEBP"),
    "gif": (file_of("GIF"), "none of JPEG, PNG, WEBP"),
    "ppm": (file_of("PPM"), "none of JPEG, PNG, WEBP"),
    "hdr": (b"#?RADIANCE\n", "none of JPEG, PNG, WEBP"),
    "exr": (b"\x76\x2f\x31\x01" + bytes(60), "none of JPEG, PNG, WEBP"),
    "moving": (moving(), "WebP that moves"),
    "nothing": (b"", "none of JPEG, PNG, WEBP"),
    "two sizes": (
        file_of("JPEG").replace(b"\xff\xdb", b"\xff\xc0\x00\x0b\x08\x00\x01\x00\x01\x01\x01\x11\x00\xff\xdb", 1),
        "broken data stream",
    ),
    "half": (file_of("JPEG", quality=95)[:-40], "truncated|broken"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_nobody_needs_never_reaches_a_decoder(name, tmp_path):
    content, text = WRONG[name]
    with pytest.raises(BadPicture, match=text):
        picture_of(compressed(0.0, content))
    path = tmp_path / "picture.png"  # a name says nothing
    path.write_bytes(content)
    with pytest.raises(BadValue, match=text):
        aspect(WorldPicture("file", str(path)))


def test_messages_that_claim_more_than_there_is_and_pictures_that_would_grow_are_refused(monkeypatch):
    huge = Image(width=8000, height=8000, step=24000, encoding="bgr8", data=b"")
    for message, text in (
        (huge, "it is 8000x8000 pixels"),
        (Image(width=4, height=2, step=2**32 - 1, encoding="bgr8", data=bytes(24)), "4x2 pixels need 24"),
    ):
        with pytest.raises(BadPicture, match=text):
            picture_of(message)
    with pytest.raises(BadPicture, match="it is 8192x67108864 pixels"):
        scaled(np.zeros((8192, 1, 3), np.uint8), 8192, 0)
    monkeypatch.setattr(vision_pictures, "LARGEST_COMPRESSED", 100)
    with pytest.raises(BadPicture, match="bytes; up to 100 are allowed"):
        picture_of(compressed(0.0, file_of("PNG")))
