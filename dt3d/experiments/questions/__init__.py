"""Questions that the papers leave open, or raise: experiments that answer them by measurements of our own."""
