"""How a mouse moves a camera: orbit, pan, zoom, and the standard views."""

from __future__ import annotations

import math

import numpy as np

from jaart.core.camera import DEFAULT_VIEW, Camera, Vector

#: Lowest and highest corner of a scene.
Bounds = tuple[Vector, Vector]

#: Directions from the middle of the scene towards the eye.
VIEWS: dict[str, Vector] = {
    "Default": DEFAULT_VIEW, "Front": (0, -1, 0), "Back": (0, 1, 0), "Left": (-1, 0, 0), "Right": (1, 0, 0),
    "Top": (0, 0, 1), "Bottom": (0, 0, -1)}

#: Highest view above or below the horizon [degrees]; beyond it, up would turn over.
STEEPEST = 89.0


def orbit(camera: Camera, right: float, up: float) -> Camera:
    """Turn the eye around the target, z staying up. right, up: degrees the scene turns on the screen."""
    away = np.subtract(camera.eye, camera.target)
    distance = float(np.linalg.norm(away))
    azimuth, height = math.atan2(away[1], away[0]), math.asin(max(-1.0, min(1.0, away[2] / distance)))
    if abs(away[0]) + abs(away[1]) < 1e-9 * distance:
        azimuth = -math.pi / 2
    azimuth -= math.radians(right)
    limit = math.radians(STEEPEST)
    height = max(-limit, min(limit, height + math.radians(up)))
    towards = np.array([math.cos(height) * math.cos(azimuth), math.cos(height) * math.sin(azimuth), math.sin(height)])
    return camera.replace(eye=tuple(camera.target + distance * towards), up=(0.0, 0.0, 1.0))


def pan(camera: Camera, right: float, down: float) -> Camera:
    """Move eye and target so that the scene follows the mouse. right, down: in longer picture sides."""
    across, up, _ = camera.frame()
    shift = (up * down - across * right) * width(camera)
    return camera.replace(eye=tuple(camera.eye + shift), target=tuple(camera.target + shift))


def zoom(camera: Camera, factor: float) -> Camera:
    """Show the scene larger by a factor: the eye comes closer, an orthographic view narrower."""
    if camera.ortho is not None:
        return camera.replace(ortho=camera.ortho / factor)
    away = np.subtract(camera.eye, camera.target)
    return camera.replace(eye=tuple(camera.target + away / factor))


def width(camera: Camera) -> float:
    """Width of the view across its longer side at the target, in cells."""
    if camera.ortho is not None:
        return camera.ortho
    distance = float(np.linalg.norm(np.subtract(camera.eye, camera.target)))
    return 2 * distance * math.tan(math.radians(camera.fov) / 2)


def view(bounds: Bounds, name: str) -> Camera:
    """The whole scene, from its lowest to its highest corner, seen from a standard direction of VIEWS."""
    return fit(bounds, VIEWS[name])


def fit(bounds: Bounds, towards: Vector, fov: float = 30.0) -> Camera:
    """The whole scene seen from a direction, from its middle towards the eye. fov: degrees."""
    return Camera.fit((np.array(bounds[0]), np.array(bounds[1])), towards, fov)


def rescaled(camera: Camera, old: Bounds, new: Bounds) -> Camera:
    """The camera that sees a scene of new corners as the old one was seen; both begin at the same corner."""
    scale = np.subtract(new[1], new[0]) / np.subtract(old[1], old[0])
    width = None if camera.ortho is None else camera.ortho * float(scale.mean())
    return camera.replace(eye=tuple(camera.eye * scale), ortho=width, target=tuple(camera.target * scale))
