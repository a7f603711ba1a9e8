"""A sensor model applied to a picture of POV-Ray: pixels, lens, point spread, noise and grey levels."""

import subprocess
from pathlib import Path

import numpy
from scene import Camera

# The number of standard deviations at which the point spread is truncated.
WIDE = 3


def trace(text: str, view: Camera, fine: int, folder: Path) -> numpy.ndarray:
    """A scene's brightness in each pixel, from 0 to 1: the mean of `fine` x `fine` lines of sight
    over the square of the pixel."""
    # It gives a grey picture this ending too.
    source, out = folder / "scene.pov", folder / "scene.ppm"
    source.write_text(text)
    out.unlink(missing_ok=True)
    command = ["povray", f"+I{source}", f"+O{out}", "Output_File_Type=P", "Bits_Per_Color=16"]
    command += ["Grayscale_Output=on", "File_Gamma=1.0", "Dither=off"]
    command += [f"+W{view.width * fine}", f"+H{view.height * fine}", "-D", "-A", "-GA", "-V"]
    told = subprocess.run(command, capture_output=True, text=True, cwd=folder)
    if told.returncode != 0 or not out.exists():
        raise RuntimeError(f"povray: {told.stderr[-2000:]}")
    shape = (view.height, fine, view.width, fine)
    return portable(out).reshape(shape).mean(axis=(1, 3))


def portable(path: Path) -> numpy.ndarray:
    """A binary PGM of 16 bits, from 0 to 1."""
    data = path.read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        end = data.index(b"\n", at)
        fields += data[at:end].split(b"#")[0].split()
        at = end + 1
    kind, width, height, top = fields[0], *map(int, fields[1:4])
    if kind != b"P5" or top != 65535:
        raise RuntimeError(f"{path.name} is no grey picture of 16 bits: {fields}")
    grey = numpy.frombuffer(data, ">u2", width * height, at)
    return grey.reshape(height, width).astype(float) / top


def vignetted(levels: numpy.ndarray, view: Camera) -> numpy.ndarray:
    """The irradiance of the lens off its axis falls with the fourth power of the cosine."""
    fx, fy, cx, cy = view.k[0, 0], view.k[1, 1], view.k[0, 2], view.k[1, 2]
    x = (numpy.arange(view.width) - cx) / fx
    y = (numpy.arange(view.height) - cy) / fy
    return levels / (1 + x[None, :] ** 2 + y[:, None] ** 2) ** 2


def blurred(levels: numpy.ndarray, sigma: float) -> numpy.ndarray:
    """The point spread: a Gaussian, sampled at the pixels; beyond the picture its nearest pixel."""
    half = int(numpy.ceil(WIDE * sigma))
    if half == 0:
        return levels
    weights = numpy.exp(-0.5 * (numpy.arange(-half, half + 1) / sigma) ** 2)
    weights /= weights.sum()
    for axis in (0, 1):
        pad = [(half, half) if a == axis else (0, 0) for a in (0, 1)]
        wide = numpy.pad(levels, pad, mode="edge")
        length = levels.shape[axis]
        moved = (numpy.take(wide, range(k, k + length), axis) for k in range(2 * half + 1))
        levels = sum(w * m for w, m in zip(weights, moved))
    return levels


def exposed(levels: numpy.ndarray, electrons: float, read_noise: float, seed: int) -> numpy.ndarray:
    """Photon noise, read noise, and the steps of 256 levels."""
    random = numpy.random.default_rng(seed)
    if electrons > 0:
        each = 255 / electrons
        levels = random.poisson(levels / each) * each
    if read_noise > 0:
        levels = levels + random.normal(0, read_noise, levels.shape)
    return numpy.clip(numpy.rint(levels), 0, 255).astype(numpy.uint8)
