"""The predicates in JAX: from integers alone, for one case in mapped code or for whole arrays of cases."""
