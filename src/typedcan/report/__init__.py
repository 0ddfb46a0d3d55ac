"""Findings of linter and comparison as text, JSON, Markdown, SARIF, JUnit, HTML and annotations."""
