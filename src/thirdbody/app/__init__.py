"""The page in the browser: ``thirdbody app``. Needs the extra ``thirdbody[app]``."""
