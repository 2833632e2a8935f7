"""Beyond the paper: the search of section 4.2 through a tree of boxes, for sites that are not even."""
