"""Beyond the paper: insertion without a history, behind method="auto"; "optimistic" locks as it does."""
