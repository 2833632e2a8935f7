"""Operations that are written once, for every machine."""
