#!/usr/bin/env python3
"""Draws the built-in dress into memory, through ctypes, and prints how much of the picture it covers."""
import ctypes
import sys


class Error(ctypes.Structure):
    _fields_ = [("code", ctypes.c_int), ("message", ctypes.c_char * 1024)]


toile = ctypes.CDLL("libtoile.so.0")
toile.toile_load.restype = ctypes.c_void_p
toile.toile_draw.restype = ctypes.c_bool
options = [b"image.width=160", b"image.height=200", b"scene.preset=draft", None]
error = Error()
scene_file = sys.argv[1].encode() if len(sys.argv) > 1 else None
scene = ctypes.c_void_p(toile.toile_load(scene_file, (ctypes.c_char_p * 4)(*options), ctypes.byref(error)))
rgba = (ctypes.c_float * (160 * 200 * 4))()
if not scene or not toile.toile_draw(scene, rgba, ctypes.c_size_t(len(rgba)), ctypes.byref(error)):
    sys.exit("example: " + error.message.decode())
print("covered: %.3f" % (sum(rgba[3::4]) / (160 * 200)))
toile.toile_destroy(ctypes.byref(scene))
