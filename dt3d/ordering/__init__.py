"""The order of sites in memory and of their insertion: along Hilbert's curve, in random rounds."""
