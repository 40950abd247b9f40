"""The accuracies that viewers share, by name."""


def rung_number(name):
    """The protocol's number of a rung's name, or of None. Raises ValueError for another name."""
    names = {None: 0, "preview": 1, "standard": 2, "fine": 3, "lossless": 4}
    if name not in names:
        raise ValueError(f"rung: {name!r} is none of preview, standard, fine, lossless")
    return names[name]
