"""Cases of a test that tries the same with several things."""

from contextlib import contextmanager


@contextmanager
def case(*names, **values):
    """Names what is tried when it fails. As unittest's subTest, of whose failures rosunit tells the number only.

    Raises:
        AssertionError: The case failed, with its name before the text.
    """
    try:
        yield
    except Exception as error:
        what = ", ".join((*map(str, names), *(f"{key}={value!r}" for key, value in values.items())))
        raise AssertionError(f"{what}: {type(error).__name__}: {error}") from error
