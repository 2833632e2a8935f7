"""The ledger: what a simulated machine did, step by step."""
