"""What does not come out as the specification of glTF says, and why. A row of which every scene agrees fails the comparison.

A row is a pattern of names of scenes, the verdict that they have unless they agree, and the reason."""

KNOWN = []
