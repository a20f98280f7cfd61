"""A page for the person topside: the annotated picture, the sentence so far, instructions and state, in a browser."""

from lightgesture.web.listener import WebListener

__all__ = [
    "WebListener",
]
