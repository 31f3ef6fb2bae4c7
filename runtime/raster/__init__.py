"""The Taichi rasteriser: batches of views of skinned scenes to pictures."""

from .types import STYLES, Camera, Frames, RenderScene, Style, Views

__all__ = ["STYLES", "Camera", "Frames", "RenderScene", "Style", "Views"]
