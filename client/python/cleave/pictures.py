"""Pictures as arrays, whatever read them."""

import numpy as np

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def grey(pixels):
    """An h x w array of bytes, 0 black, 255 white, of a grey, RGB or RGBA picture of bytes or of floats.

    What is transparent is white. Raises ValueError for other shapes and values.
    """
    picture = np.asarray(pixels)
    if picture.ndim not in (2, 3) or picture.ndim == 3 and picture.shape[2] not in (3, 4):
        raise ValueError(f"pixels: of shape {picture.shape}; h x w, h x w x 3 or h x w x 4 is required")
    if picture.dtype == np.uint8 and picture.ndim == 2:
        return picture
    values = picture / 255 if picture.dtype == np.uint8 else picture.astype(np.float64)
    if not ((values >= 0) & (values <= 1)).all():
        raise ValueError("pixels: bytes, or numbers from 0 to 1, are required")
    if values.ndim == 3:
        colours = values[..., :3] @ _LUMINANCE
        if values.shape[2] == 4:
            colours = colours * values[..., 3] + 1 - values[..., 3]
        values = colours
    return np.round(255 * values).astype(np.uint8)
