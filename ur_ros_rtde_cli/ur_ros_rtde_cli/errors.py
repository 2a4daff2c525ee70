"""What is wrong with a request, in words for whoever made it."""


class Problem(Exception):
    pass
