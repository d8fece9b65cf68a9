"""Light linking: which lamps light which objects, as groups of receivers.

A lamp's receiver collection holds the objects that it lights, or those that it does not. Objects that the same lamps light are one group; objects that no
collection names are the group `rest`.
"""

from .lamps import has_light

MOST = 31
"""Groups of receivers that a scene file may name, beside `rest`."""


class Links:
    """The links of a scene: `receiver` of an object, and `of_lamp`, the keys of a lamp's entry."""

    def __init__(self, scene, report):
        included, excluded = {}, {}
        for lamp in scene.objects:
            collection = getattr(getattr(lamp, "light_linking", None), "receiver_collection", None)
            if collection is None:
                continue
            if not has_light(lamp):
                report.add(f"object {lamp.name}", "light linking of a glowing mesh", "it shines on everything")
                continue
            included[lamp.name], excluded[lamp.name] = _members(collection)
        named = set().union(*included.values(), *excluded.values()) if included else set()
        # Objects that are lit by the same of the lamps that have links.
        self._groups, self._lit = {}, {lamp: [] for lamp in included}
        names = {}
        for thing in [None, *(thing.name for thing in scene.objects if thing.name in named)]:
            lamps = tuple(lamp for lamp in included if _is_lit(thing, included[lamp], excluded[lamp]))
            if lamps not in names:
                if len(names) > MOST:
                    report.add(f"object {thing}", f"one more of {MOST} groups of light linking", "every lamp lights it that lights objects without links")
                    continue
                names[lamps] = f"linked_{len(names)}" if names else "rest"
                for lamp in lamps:
                    self._lit[lamp].append(names[lamps])
            if thing is not None and names[lamps] != "rest":
                self._groups[thing] = names[lamps]
        self._all = list(names.values())

    def receiver(self, thing):
        """The name of an object's group; None where it is `rest`."""
        return self._groups.get(thing.name)

    def of_lamp(self, lamp, report):
        """What a lamp says of receivers, as keys of its light or material; None where it lights nothing."""
        lit = self._lit.get(lamp.name)
        if lit is None or lit == self._all:
            return {}
        if not lit:
            report.add(f"lamp {lamp.name}", "light linking to nothing", "it is left out")
            return None
        return {"lights_only": lit}


def _members(collection):
    """Names of objects that a collection includes and excludes; those of collections within it as that collection is."""
    names = {"INCLUDE": set(), "EXCLUDE": set()}
    for thing, link in zip(collection.objects, collection.collection_objects):
        names[link.light_linking.link_state].add(thing.name)
    for child, link in zip(collection.children, collection.collection_children):
        names[link.light_linking.link_state].update(thing.name for thing in child.all_objects)
    return names["INCLUDE"], names["EXCLUDE"]


def _is_lit(thing, included, excluded):
    return thing in included if included else thing not in excluded
